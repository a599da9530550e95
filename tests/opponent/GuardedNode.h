// A node as the opponent meets it: the guard and the meeting in front of a model of a DDS implementation, in
// virtual time.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "Sequence.h"
#include "guard/PeerObserver.h"
#include "guard/RtpsGuard.h"
#include "rtps/Implementation.h"
#include "rtps/Meeting.h"

namespace Opponent
{

// A vendor, as far as the things that the guard admits cost it something. Both vendors step through
// each number that a writer says is absent, and keep every announcement until it is disposed of.
class Vendor
{
public:
    // Heartbeats and gaps beyond this number are counted, and not walked through: that would take hours.
    static constexpr std::int64_t Farthest = 4096;

    Vendor(const GuidPrefix &name, std::function<void(const Bytes &)> send) : Dds(name, std::move(send)) {}

    void Receive(std::span<std::uint8_t> message, TimePoint now);
    // The places at which participants have readers: each gets a copy of each sample.
    const std::set<Rabit::Rtps::Place> &Readers() const { return _readers; }
    // Where the participant is reached; empty if it is not known.
    std::optional<Rabit::Rtps::Place> PlaceOf(const GuidPrefix &name) const;

    Implementation Dds;
    std::uint64_t Walked = 0;                 // numbers
    std::map<GuidPrefix, TimePoint> Beats{};  // when the newest one of each node came

private:
    struct Peer
    {
        std::optional<Rabit::Rtps::Place> At;                      // its locator for samples
        std::map<std::pair<EntityId, EntityId>, Bytes> Endpoints;  // by the announcing writer
        std::map<EntityId, std::int64_t> Highest;
    };

    void Announced(Peer &peer, const Rabit::Rtps::Delivery &said, const Rabit::Rtps::Submessage &part);
    bool IsWalkable(Peer &peer, Rabit::Rtps::SubmessageKind kind, const Rabit::Rtps::Delivery &said);

    void FindReaders();

    std::map<GuidPrefix, Peer> _peers;
    std::set<Rabit::Rtps::Place> _readers;
};

class GuardedNode final : private Rabit::Rtps::PeerObserver
{
public:
    static constexpr std::chrono::seconds Period{10};  // of announcements
    static constexpr std::chrono::milliseconds BeatPeriod{500};
    static constexpr std::chrono::milliseconds SamplePeriod{50};
    static constexpr std::size_t SampleSize = 128;

    // `send` gets what goes to all.
    GuardedNode(std::uint8_t number, std::function<void(const Bytes &)> send);

    void Arrive(std::span<const std::uint8_t> datagram, const Rabit::Rtps::HostAddress &from, TimePoint now);
    void Step(TimePoint now);

    // True if it has met that node, with its endpoints.
    bool Knows(const GuardedNode &other) const;

    const GuidPrefix Name;
    const Rabit::Rtps::HostAddress Host;
    Vendor Dds;
    std::uint64_t SentBytes = 0;

private:
    void HeardUnknown(const GuidPrefix &peer) override { _meeting.HeardUnknown(peer, _now); }
    void Announced(const GuidPrefix &peer, bool hasCard) override { _meeting.Announced(peer, hasCard, _now); }
    void Gone(const GuidPrefix &peer) override { _meeting.SaidGoodbye(peer, _now); }
    void Spoke(const GuidPrefix &peer) override { _meeting.Spoke(peer); }
    bool IsReplayed(const GuidPrefix &peer) const override { return _meeting.IsReplayed(peer); }

    void FromVendor(const Bytes &message);
    void Send(const Bytes &datagram);
    void Announce();
    void EndSilent();

    const std::function<void(const Bytes &)> _send;
    TimePoint _now{};
    Rabit::Rtps::Meeting _meeting;
    Rabit::Rtps::RtpsGuard _guard;
    Rabit::HardwareAddresses _addresses{[] { return std::string(); }};  // the kernel awaits none
    std::int64_t _beats = 0;
    std::optional<TimePoint> _begun;
    std::uint64_t _announcements = 0;
};

}  // namespace Opponent
