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
#include "wire/AgreementNews.h"
#include "wire/LinkStrain.h"
#include "wire/ProblemCount.h"

namespace Rabit
{

// The other nodes, as their beats describe them: state, incarnation and announcement of each.
//
// A pure state machine: no I/O, no threads, no clock of its own. `now` is this node's monotonic clock, and
// never goes back. Used by the gateway's thread only.
class PeerTable
{
public:
    using Duration = std::chrono::nanoseconds;

    // A node tells the time to its next beat. It is STALE after StaleAfterBeats times that time without a
    // beat, LOST after LostAfterBeats times, or when SetLostAfter says.
    static constexpr int StaleAfterBeats = 3;
    static constexpr int LostAfterBeats = 7;
    // The time that a node tells is clamped to this range.
    static constexpr Duration ShortestPeriod = std::chrono::milliseconds(100);
    static constexpr Duration LongestPeriod = std::chrono::seconds(60);
    // A node's beat is echoed once in EchoPeriod, or with every EchoEachBeats-th beat of ours where that is
    // more seldom. The round trip to a newcomer is measured at once. A tool is echoed EchoesToTool times at
    // first, since it may not hear this node yet and does not stay for EchoPeriod. If this node's clock stood
    // still, a peer takes its beats for old ones; that peer's beat is echoed with the next beat.
    static constexpr Duration EchoPeriod = std::chrono::seconds(4);
    static constexpr int EchoEachBeats = 8;
    static constexpr int EchoesToTool = 3;
    // Problems that a node has not told again for this time are forgotten (BeatContents::ProblemPeriod).
    static constexpr Duration ProblemMemory = std::chrono::seconds(60);
    // Least time between two announcements that are accepted in one incarnation.
    static constexpr Duration OffersRest = std::chrono::seconds(1);
    // Names come from the network. When one more node comes, the node LOST for longest is forgotten, never a
    // node that is live or needed. If none can be forgotten, the new node's beats are dropped and counted.
    static constexpr std::size_t MaximumPeers = 1000;
    // Most tools that are kept beside the nodes, while their beats come. Beats of further tools are ignored,
    // except for their questions.
    static constexpr std::size_t MostTools = 32;

    struct Peer
    {
        std::string Node;
        std::uint64_t Incarnation = 0;
        std::uint32_t Tag = 0;                   // of node and incarnation (names/NodeTag.h)
        bool IsTool = false;                     // UP as long as it is kept; it has no offers and no states
        bool IsReplay = false;                   // it plays a recording
        std::optional<AgreementNews> Agreement;  // as its newest beat tells; empty: it has none
        std::vector<LinkStrain> Strains;         // as its newest beat reports them
        // It hears this node by this path and by no better one (gateway/paths), as its newest beat says.
        bool HearsHereFirst = false;
        // The sum of the nodes that it hears, as its beats told last (BeatExtensions::FleetSum).
        std::optional<std::uint32_t> FleetSum;
        ProblemCount Problems;         // as its beats told last, now and then
        bool HasToldProblems = false;  // since its incarnation is heard
        Duration ProblemsTold{0};
        Gateway::NodeState State = Gateway::NodeState::LOST;
        std::string Reason;
        Duration FirstHeard{0};
        Duration LastHeard{0};  // when its newest beat was sent, by this node's clock
        Duration Period{0};     // the next beat is due by LastHeard + Period
        PeerClock Clock;
        BeatCount Beats;  // of this incarnation
        // Its newest announcement that came. That of an earlier incarnation is kept if its digest is the
        // same.
        std::optional<Gateway::Announcement> Offers;
        Duration OffersSince{0};
        std::uint32_t OffersDigest = 0;  // of Offers
        // Versions of its States, in the order of the announcement with the digest BeatsOffers, as far as
        // beats of this incarnation have told them; 0: never written, or not told yet.
        std::vector<std::uint32_t> States;
        std::uint32_t BeatsOffers = 0;  // digest of the announcement in its newest beats
        bool Twice = false;             // another live node has the same name
        // Where this node and its twin run, as far as they have told (Whereabouts).
        std::string Place;
        std::string TwinPlace;

        // True if Offers has the digest in its beats, so that States refers to it.
        bool HasPresentOffers() const { return Offers && OffersDigest == BeatsOffers; }
        Duration StaleAfter() const { return StaleAfterBeats * Period; }
        Duration LostAfter() const
        {
            return LostStated > Duration(0) ? std::max(LostStated, StaleAfter()) : LostAfterBeats * Period;
        }
        Duration LostStated{0};  // PeerTable::SetLostAfter; 0: it is not stated

        // The contents of the next echo to it.
        Duration LastBeatSource{0};
        Duration LastBeatArrival{0};
        int FirstEchoesLeft = 1;
        Duration LastEchoed{0};
        bool DoubtsThisNode = false;  // it needs an echo to believe that this node's beats are new
        // The last beat of a lower incarnation. A beat of yet another incarnation replaces it once it is old.
        struct Earlier
        {
            std::uint64_t Incarnation = 0;
            Duration Source{0};
            Duration Arrival{0};
        };
        std::optional<Earlier> OfEarlierLife;
        int TwinBeats = 0;      // beats of another incarnation that alternate with this one's
        Duration TwinSince{0};  // when the last of them came
    };

    // Peer::Reason of a node that is LOST since it said goodbye.
    static constexpr const char *Left = "left";

    // True if a node must be remembered although it is gone.
    using IsNeeded = std::function<bool(const std::string &node)>;

    PeerTable(std::string ownNode, std::uint64_t ownIncarnation, IsNeeded isNeeded = {});

    // True if a node's announcement is wanted.
    using IsAsked = std::function<bool(const std::string &node)>;
    // This node is a tool, which heeds the sums that the nodes tell. Without `isAsked` it wants all
    // announcements, as a node does.
    void BeTool(IsAsked isAsked)
    {
        _isTool = true;
        _isAsked = std::move(isAsked);
    }

    // The changes by one input, so that the gateway can react at once.
    struct Change
    {
        bool Beat = false;                   // a new beat of a present incarnation
        bool State = false;                  // a state or an incarnation changed: worth posting
        bool NewLife = false;                // a node is UP in an incarnation that was not known
        bool Offers = false;                 // an announcement said something new
        std::vector<std::string> Forgotten;  // nodes that made room for another one, and tools that are gone

        bool Any() const { return Beat || State || NewLife || Offers || !Forgotten.empty(); }
    };

    Change OnBeat(const HeardBeat &heard);
    // The transport saw the node close its session.
    Change OnLeft(const std::string &node, std::uint64_t incarnation);
    // Takes over the announcement of a node, if its beats here have the same digest, so that it need not be
    // requested by this path. Returns true if this table lacked it.
    bool Adopt(const Peer &elsewhere);
    // Lets time pass. Before NextChange it does nothing, however many peers there are.
    Change Advance(Duration now);
    // When Advance may next change something, and not later; empty: not before the next input.
    std::optional<Duration> NextChange() const;

    const Peer *Find(const std::string &node) const;
    // Nodes that have been heard, by name; no tools.
    std::vector<const Peer *> Heard() const;
    // BeatExtensions::FleetSum of this node.
    std::uint32_t FleetSum() const;
    // Tools that are kept, by name; their number; and how many have come since the beginning.
    std::vector<std::string> HeardTools() const;
    std::size_t Tools() const { return _tools; }
    std::uint64_t ToolsCome() const { return _toolsCome; }
    // Number of nodes forgotten, and of beats dropped because no room could be made for their node.
    std::uint64_t Forgotten() const { return _forgotten; }
    std::uint64_t CrowdedOut() const { return _crowdedOut; }
    // True if another live node uses this node's name.
    bool OwnNameTwice() const { return _ownTwice; }
    // Where that node runs; empty while it has not told.
    const std::string &OwnTwinPlace() const { return _ownTwinPlace; }
    // The announcements that this node lacks and requests.
    MissingOffers &Missing() { return _missing; }
    const MissingOffers &Missing() const { return _missing; }
    // Number of announcements that were complete and could not be used.
    std::uint64_t Malformed() const { return _malformed + _missing.Wrong(); }
    // A beat of this node was sent, which carried `source` as its source time.
    void NoteSent(std::int64_t source, Duration now) { _sent.Add(source, now); }
    // States after how long a node is LOST, in place of LostAfterBeats, but not before it is STALE. Before
    // the first input.
    void SetLostAfter(Duration time) { _lostAfter = time; }
    // Sets the time between this node's beats.
    void SetBeatPeriod(Duration period) { _echoPeriod = std::max(EchoPeriod, EchoEachBeats * period); }
    // Number of echoes due: all for peers that doubt this node, and at most `usual` others.
    std::size_t EchoesDue(Duration now, std::size_t usual) const;
    // The due echoes, at most `most`: first for the peers that doubt this node, then for the others in turns.
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
    bool NoteTwin(Peer &peer, const HeardBeat &heard);
    Duration OwnChange() const;
    void Expect(const Peer &peer);
    static void BeginLife(Peer &peer, const HeardBeat &heard);
    bool IsEchoDue(const Peer &peer, Duration now) const;
    static bool IsEchoUrgent(const Peer &peer);
    void TakeIn(Peer &peer, const HeardBeat &heard, Change &change);
    static bool TakeProblems(Peer &peer, const HeardBeat &heard);
    void Measure(Peer &peer, const HeardBeat &heard) const;
    void MeasureRoundTrip(Peer &peer, const HeardBeat &heard) const;
    void TakeStates(Peer &peer, const Gateway::Beat &beat);
    void CompareOffers(Peer &peer, const HeardBeat &heard, Change &change);
    bool SetState(Peer &peer, Gateway::NodeState state, const std::string &reason);

    const std::string _ownNode;
    const std::uint64_t _ownIncarnation;
    const std::uint32_t _ownTag;
    const IsNeeded _isNeeded;
    bool _isTool = false;
    IsAsked _isAsked;
    std::map<std::string, Peer> _peers;
    std::size_t _tools = 0;  // of these
    std::uint64_t _toolsCome = 0;
    MissingOffers _missing;
    SentBeats _sent;
    Duration _nextChange = Duration::max();  // not later than the next change by Advance
    std::uint64_t _forgotten = 0;
    std::uint64_t _crowdedOut = 0;
    std::uint64_t _malformed = 0;
    Duration _echoPeriod = EchoPeriod;
    Duration _lostAfter{0};  // 0: it is not stated
    std::string _lastEchoed;
    std::string _lastReassured;  // of those that doubt this node
    int _ownTwinBeats = 0;
    Duration _ownTwinSince{0};
    bool _ownTwice = false;
    std::string _ownTwinPlace;
};

}  // namespace Rabit
