#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clocks/PeerClock.h"
#include "gateway.idl.h"

namespace Rabit
{

// What this node knows of the others: who is there, in which life, and what each one offers. Presence rests
// on beats alone, never on announcements, which the network may replay long after their node has gone.
//
// A pure state machine: no I/O, no threads, no clock of its own. `now` is this node's monotonic clock, and
// never goes back. Used by the gateway's thread only.
class PeerTable
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration BeatPeriod = std::chrono::milliseconds(500);
    static constexpr Duration StaleAfter = std::chrono::milliseconds(1500);
    static constexpr Duration LostAfter = std::chrono::milliseconds(3500);
    // Who lacks an announcement asks for it after this time: it may be on its way.
    static constexpr Duration AskAfter = std::chrono::milliseconds(300);
    // A node's beat goes back to it so often. The round trip of one that has just come is measured at once.
    static constexpr Duration EchoPeriod = std::chrono::seconds(4);
    // Names come from the network. When another one comes one is forgotten that has never been heard, else,
    // if the new one was heard, the one LOST for longest; never one that is live or needed. If there is none,
    // what the new one says is dropped and counted.
    static constexpr std::size_t MaximumPeers = 1000;

    struct Peer
    {
        std::string Node;
        std::uint64_t Incarnation = 0;
        bool Heard = false;  // a beat of this life has come; until then it is shown nowhere
        Gateway::NodeState State = Gateway::NodeState::LOST;
        std::string Reason;
        Duration KnownSince{0};
        Duration FirstHeard{0};
        Duration LastHeard{0};  // when its newest beat was sent, by this node's clock
        PeerClock Clock;
        std::optional<Gateway::Announcement> Offers;
        Duration OffersSince{0};
        std::uint32_t OffersDigest = 0;            // of Offers
        std::optional<Duration> LacksOffersSince;  // its beats say that Offers is not what it offers
        // Versions of its States in the order of the announcement that its beats mean, as far as they have
        // told in this life; 0: never written, or not told yet.
        std::vector<std::uint32_t> States;
        bool Twice = false;                        // another live node has the same name

        // What its next echo says.
        Duration LastBeatMonotonic{0};
        Duration LastBeatArrival{0};
        std::optional<Duration> LastEchoed;
        // Beats of another incarnation since the last check for twins.
        int TwinBeats = 0;
        Duration TwinSince{0};
    };

    // Whether a node must be remembered although it is gone.
    using IsNeeded = std::function<bool(const std::string &node)>;

    PeerTable(std::string ownNode, std::uint64_t ownIncarnation, IsNeeded isNeeded = {});

    // What an input changed, so that the gateway can react at once.
    struct Change
    {
        bool State = false;                  // a state or an incarnation: worth posting
        bool NewLife = false;                // a node that was not known in this incarnation is UP
        bool Offers = false;                 // an announcement said something new
        std::vector<std::string> Forgotten;  // nodes that made room for another one
    };

    Change OnBeat(const Gateway::Beat &beat, Duration now);
    Change OnAnnouncement(const Gateway::Announcement &announcement, Duration now);
    // The transport saw the node close its session.
    Change OnLeft(const std::string &node, std::uint64_t incarnation);
    // Lets time pass.
    Change Advance(Duration now);
    // When Advance would next change something; empty: not before the next input.
    std::optional<Duration> NextChange() const;

    const Peer *Find(const std::string &node) const;
    // Nodes that have been heard, by name.
    std::vector<const Peer *> Heard() const;
    // Nodes forgotten, and beats and announcements dropped because no room could be made for their node.
    std::uint64_t Forgotten() const { return _forgotten; }
    std::uint64_t CrowdedOut() const { return _crowdedOut; }
    // Whether another live node uses this node's name.
    bool OwnNameTwice() const { return _ownTwice; }
    // At most `most` nodes whose announcement is to be asked for, in turns.
    std::vector<std::string> NextWanted(Duration now, std::size_t most);
    // At most `most` echoes, of the nodes whose turn it is.
    std::vector<Gateway::BeatEcho> NextEchoes(Duration now, std::size_t most);

private:
    Peer *GetOrMake(const std::string &node, bool heard, Duration now, Change &change);
    bool ForgetOne(bool forOneHeard, Change &change);
    bool IsNewLife(const Peer &peer, std::uint64_t incarnation, Duration now) const;
    void NoteTwin(Peer &peer, Duration now);
    static void BeginLife(Peer &peer, std::uint64_t incarnation);
    static void CompareOffers(Peer &peer, std::uint32_t digest, Duration now);
    static bool SetState(Peer &peer, Gateway::NodeState state, const std::string &reason);
    void MeasureRoundTrip(Peer &peer, const Gateway::Beat &beat, Duration now) const;

    std::string _ownNode;
    std::uint64_t _ownIncarnation;
    const IsNeeded _isNeeded;
    std::map<std::string, Peer> _peers;
    std::uint64_t _forgotten = 0;
    std::uint64_t _crowdedOut = 0;
    std::string _lastEchoed;
    std::string _lastWanted;
    int _ownTwinBeats = 0;
    Duration _ownTwinSince{0};
    bool _ownTwice = false;
};

}  // namespace Rabit
