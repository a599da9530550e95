#pragma once

#include "FleetWorld.h"

#include <rabit/RabitQueueReceipt.h>
#include <rabit/simulated/SimulatedNetwork.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "gateway.idl.h"
#include "simulation.idl.h"

namespace Rabit::Sim
{

// Knows the promises about queue messages and hears what managers see of them. Fails on a broken promise.
class NoteOracle
{
public:
    static constexpr std::size_t MostNodes = 6;

    struct Counts
    {
        std::uint64_t Accepted = 0;
        std::uint64_t RefusedFull = 0;
        std::uint64_t RefusedUnknown = 0;
        std::uint64_t Delivered = 0;
        std::uint64_t Expired = 0;
        std::uint64_t InDoubt = 0;
        std::uint64_t GivenUp = 0;  // of those: expired while nothing came from the receiver
        std::uint64_t DeliveredAgain = 0;
        std::uint64_t SentToAll = 0;
        std::uint64_t LargeDelivered = 0;  // of several parts each
    };

    // `clockOf` returns the present reading of the monotonic clock of a life's process.
    NoteOracle(FleetWorld &world, const SimulatedNetwork &network,
               std::function<Time(std::size_t life)> clockOf);

    // A life begins or ends: messages on their way to or from the node may be in doubt.
    void OnEpoch(std::size_t node)
    {
        ++_epochs[node];
        _largePending[node] = 0;
    }

    // Fills in the next note of a life, and its receipt.
    Note Make(std::size_t life, std::size_t destination, SimRandom &random);
    std::shared_ptr<RabitQueueReceipt> MakeReceipt(std::uint64_t note);
    // AddMessageToQueue returned `accepted`. `localNow`: the sender's monotonic clock.
    void OnSent(std::uint64_t note, bool accepted, Time localNow);
    // A note was put into the queue of a life; `arrivedAt` is true time and `sourceNow` the reading that the
    // sender's monotonic clock had then.
    void OnArrived(std::size_t life, const Note &note, bool redelivered, Time sourceNow);
    // Checks the counters of the gateway of a life.
    void OnFleet(std::size_t life, const Gateway::Fleet &fleet);
    // The life ended in an orderly way: all its notes have an outcome.
    void OnLeft(std::size_t life);

    // Returns the life that sent the note.
    std::size_t SourceLife(std::uint64_t note) const { return _records[note].Life; }
    std::size_t Notes() const { return _records.size(); }
    // Number of accepted notes without an outcome, from lives that go on to nodes for which `alive` is
    // true.
    std::size_t Undrained(const std::vector<bool> &alive) const;
    // True if a large note of the node, of several parts, is accepted and without an outcome.
    bool HasLargePending(std::size_t node) const { return _largePending[node] > 0; }
    Time LastOutcomeAt() const { return _lastOutcomeAt; }
    // Fails if a receipt counts more deliveries than arrivals. Call it at the end of the run.
    void CheckDelivered();

    const Counts &Total() const { return _counts; }

private:
    struct Record
    {
        std::size_t Life = 0;
        std::size_t Destination = 0;  // or Burst::ToAll
        Time SentAt{0};               // by the sender's monotonic clock
        bool Accepted = false;
        bool Known = false;  // its receipt has an outcome
        QueueOutcome Outcome = QueueOutcome::Pending;
        std::uint32_t Bytes = 0;
        std::array<std::uint8_t, MostNodes> Arrivals{};     // by node
        std::array<std::uint32_t, MostNodes> EpochsThen{};  // when it was sent
        std::array<std::uint32_t, MostNodes> KnownThen{};   // the same, as far as its sender must have known
        std::shared_ptr<RabitQueueReceipt> Receipt;
    };
    struct LinkState
    {
        std::size_t Life = static_cast<std::size_t>(-1);
        std::size_t Pending = 0;
        bool WasKnown = false;  // to this life
        bool ExactlyKnown = true;
        // The epoch of the destination from which the sender has had an answer.
        std::uint32_t KnownEpoch = 0;
    };
    struct Stream
    {
        std::uint64_t Next = 0;         // notes below it must not come any more, unless they are flagged
        std::uint64_t NextFlagged = 0;  // the same for flagged ones, within one epoch
        std::uint32_t FlaggedEpoch = 0;
    };

    bool IsLarge(const Record &record) const;
    void OnOutcome(std::uint64_t note);
    void CheckOutcome(const Record &record, std::uint64_t note);
    const SendRule &RuleOf(std::size_t source, std::size_t destination) const
    {
        return _world.Plan.Machines[source].Send[destination];
    }
    std::uint32_t EpochOf(std::size_t a, std::size_t b) const { return _epochs[a] + _epochs[b]; }
    // True if an end restarted after the sender knew of the other end's life and sent the note. A note to a
    // life of which the sender had not heard yet may be in doubt as well.
    bool MayBeInDoubt(const Record &record, std::size_t destination) const
    {
        const std::size_t source = _world.Lives[record.Life].Node;
        return record.EpochsThen[source] + record.KnownThen[destination] != EpochOf(source, destination);
    }

    // True if the note has expired and the links have heard nothing from the destination for so long that
    // the sender gives up.
    bool IsGivenUp(const Record &record) const;

    FleetWorld &_world;
    const SimulatedNetwork &_network;
    const std::function<Time(std::size_t life)> _clockOf;
    std::array<std::uint32_t, MostNodes> _epochs{};
    std::deque<Record> _records;                                      // stays in place
    std::map<std::pair<std::size_t, std::size_t>, LinkState> _links;  // by source and destination
    std::map<std::pair<std::size_t, std::size_t>, Stream> _streams;   // the same
    std::array<std::size_t, MostNodes> _largePending{};               // by sender
    Counts _counts;
    Time _lastOutcomeAt{0};
};

}  // namespace Rabit::Sim
