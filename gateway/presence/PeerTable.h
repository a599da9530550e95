#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clocks/PeerClock.h"
#include "gateway.idl.h"
#include "presence/BeatCount.h"
#include "presence/HeardBeat.h"
#include "presence/MissingOffers.h"
#include "presence/SentBeats.h"
#include "wire/LinkStrain.h"

namespace Rabit
{

// What this node knows of the others, from their beats: who is there, in which life, and what each one
// offers.
//
// A pure state machine: no I/O, no threads, no clock of its own. `now` is this node's monotonic clock, and
// never goes back. Used by the gateway's thread only.
class PeerTable
{
public:
    using Duration = std::chrono::nanoseconds;

    // A node says when its next beat is due; it is STALE after so many times that, and LOST after so many.
    static constexpr int StaleAfterBeats = 3;
    static constexpr int LostAfterBeats = 7;
    // What it says is raised or lowered to what a node can mean.
    static constexpr Duration ShortestPeriod = std::chrono::milliseconds(100);
    static constexpr Duration LongestPeriod = std::chrono::seconds(60);
    // A node's beat goes back to it so often, or with each so manieth of our beats where that is more seldom.
    // The round trip of one that has just come is measured at once. A peer that takes this node's beats for
    // old ones, since this node's clock stood still, is echoed with the next beat.
    static constexpr Duration EchoPeriod = std::chrono::seconds(4);
    static constexpr int EchoEachBeats = 8;
    // Another announcement in the same life is taken so long after the one before at the earliest.
    static constexpr Duration OffersRest = std::chrono::seconds(1);
    // Names come from the network. When another one comes the one LOST for longest is forgotten; never one
    // that is live or needed. If there is none, what the new one says is dropped and counted.
    static constexpr std::size_t MaximumPeers = 1000;
    // Tools are kept beside them while they are there, so many; what more of them say is not looked at, but
    // for what they ask.
    static constexpr std::size_t MostTools = 32;

    struct Peer
    {
        std::string Node;
        std::uint64_t Incarnation = 0;
        std::uint32_t Tag = 0;            // of node and incarnation (names/NodeTag.h)
        bool IsTool = false;              // UP as long as it is kept; it has no offers and no states
        bool IsReplay = false;            // what it posts was recorded before
        std::vector<LinkStrain> Strains;  // that its newest beat tells of
        Gateway::NodeState State = Gateway::NodeState::LOST;
        std::string Reason;
        Duration FirstHeard{0};
        Duration LastHeard{0};  // when its newest beat was sent, by this node's clock
        Duration Period{0};     // how long after that the next one is due at the latest
        PeerClock Clock;
        BeatCount Beats;  // of this life
        // The newest announcement that came of it. One of an earlier life is kept if its beats mean the same.
        std::optional<Gateway::Announcement> Offers;
        Duration OffersSince{0};
        std::uint32_t OffersDigest = 0;  // of Offers
        // Versions of its States in the order of the announcement that its beats mean, as far as they have
        // told in this life; 0: never written, or not told yet.
        std::vector<std::uint32_t> States;
        std::uint32_t BeatsOffers = 0;  // digest of that announcement
        bool Twice = false;             // another live node has the same name
        // Where this one and that one run, as far as they have said so (Whereabouts).
        std::string Place;
        std::string TwinPlace;

        // Whether Offers is what its beats mean, so that States tells of them.
        bool HasPresentOffers() const { return Offers && OffersDigest == BeatsOffers; }
        Duration StaleAfter() const { return StaleAfterBeats * Period; }
        Duration LostAfter() const { return LostAfterBeats * Period; }

        // What its next echo says.
        Duration LastBeatSource{0};
        Duration LastBeatArrival{0};
        std::optional<Duration> LastEchoed;
        bool DoubtsThisNode = false;  // it needs an echo to believe that this node's beats are new
        // The last beat of a lower incarnation. One of yet another incarnation takes its place once it is
        // old.
        struct Earlier
        {
            std::uint64_t Incarnation = 0;
            Duration Source{0};
            Duration Arrival{0};
        };
        std::optional<Earlier> OfEarlierLife;
        int TwinBeats = 0;      // beats of another incarnation, as far as they alternate with this one's
        Duration TwinSince{0};  // when the last of them came
    };

    // Whether a node must be remembered although it is gone.
    using IsNeeded = std::function<bool(const std::string &node)>;

    PeerTable(std::string ownNode, std::uint64_t ownIncarnation, IsNeeded isNeeded = {});

    // Whether a node's announcement is wanted; without it all are.
    using IsAsked = std::function<bool(const std::string &node)>;
    void SetIsAsked(IsAsked isAsked) { _isAsked = std::move(isAsked); }

    // What an input changed, so that the gateway can react at once.
    struct Change
    {
        bool Beat = false;                   // a new beat of a present life
        bool State = false;                  // a state or an incarnation: worth posting
        bool NewLife = false;                // a node that was not known in this incarnation is UP
        bool Offers = false;                 // an announcement said something new
        std::vector<std::string> Forgotten;  // nodes that made room for another one, and tools that are gone

        bool Any() const { return Beat || State || NewLife || Offers || !Forgotten.empty(); }
    };

    Change OnBeat(const HeardBeat &heard);
    // The transport saw the node close its session.
    Change OnLeft(const std::string &node, std::uint64_t incarnation);
    // Lets time pass.
    Change Advance(Duration now);
    // When Advance would next change something; empty: not before the next input.
    std::optional<Duration> NextChange() const;

    const Peer *Find(const std::string &node) const;
    // Nodes that have been heard, by name; no tools.
    std::vector<const Peer *> Heard() const;
    // How many tools are there.
    std::size_t Tools() const { return _tools; }
    // Nodes forgotten, and beats dropped because no room could be made for their node.
    std::uint64_t Forgotten() const { return _forgotten; }
    std::uint64_t CrowdedOut() const { return _crowdedOut; }
    // Whether another live node uses this node's name.
    bool OwnNameTwice() const { return _ownTwice; }
    // Where that one runs; empty while it has not said so.
    const std::string &OwnTwinPlace() const { return _ownTwinPlace; }
    // The announcements that are lacking, to be asked for.
    MissingOffers &Missing() { return _missing; }
    const MissingOffers &Missing() const { return _missing; }
    // Announcements that were whole and made no sense.
    std::uint64_t Malformed() const { return _malformed + _missing.Wrong(); }
    // A beat of this node was sent, which said so of the source clock.
    void NoteSent(std::int64_t source, Duration now) { _sent.Add(source, now); }
    // How often this node beats.
    void SetBeatPeriod(Duration period) { _echoPeriod = std::max(EchoPeriod, EchoEachBeats * period); }
    // How many echoes are due: all for peers that doubt this node, and no more than `usual` others.
    std::size_t EchoesDue(Duration now, std::size_t usual) const;
    // Those, `most` at most: first for the peers that doubt this node, then for the others whose turn it is.
    std::vector<Gateway::BeatEcho> NextEchoes(Duration now, std::size_t usual, std::size_t most);

private:
    Peer *GetOrMake(const std::string &node, Change &change);
    bool ForgetOne(Change &change);
    Change OnOwnName(const HeardBeat &heard);
    Change OnToolBeat(const HeardBeat &heard);
    Peer *GetOrMakeTool(const HeardBeat &heard);
    std::map<std::string, Peer>::iterator ForgetTool(std::map<std::string, Peer>::iterator tool,
                                                     Change &change);
    Change OnGoodbye(const HeardBeat &heard);
    static bool IsNewLife(Peer &peer, const HeardBeat &heard);
    static bool NoteTwin(Peer &peer, const HeardBeat &heard);
    static void BeginLife(Peer &peer, const HeardBeat &heard);
    bool IsEchoDue(const Peer &peer, Duration now) const;
    static bool IsEchoUrgent(const Peer &peer);
    void TakeIn(Peer &peer, const HeardBeat &heard, Change &change);
    void Measure(Peer &peer, const HeardBeat &heard) const;
    void MeasureRoundTrip(Peer &peer, const HeardBeat &heard) const;
    void TakeStates(Peer &peer, const Gateway::Beat &beat);
    void CompareOffers(Peer &peer, const HeardBeat &heard, Change &change);
    bool SetState(Peer &peer, Gateway::NodeState state, const std::string &reason);

    const std::string _ownNode;
    const std::uint64_t _ownIncarnation;
    const std::uint32_t _ownTag;
    const IsNeeded _isNeeded;
    IsAsked _isAsked;
    std::map<std::string, Peer> _peers;
    std::size_t _tools = 0;  // of these
    MissingOffers _missing;
    SentBeats _sent;
    std::uint64_t _forgotten = 0;
    std::uint64_t _crowdedOut = 0;
    std::uint64_t _malformed = 0;
    Duration _echoPeriod = EchoPeriod;
    std::string _lastEchoed;
    std::string _lastReassured;  // of those that doubt this node
    int _ownTwinBeats = 0;
    Duration _ownTwinSince{0};
    bool _ownTwice = false;
    std::string _ownTwinPlace;
};

}  // namespace Rabit
