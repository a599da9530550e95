#pragma once

#include <rabit/RabitClock.h>
#include <rabit/gateway/RandomSource.h>
#include <rabit/transport/Transport.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clocks/SourceClock.h"
#include "gateway.idl.h"
#include "presence/BeatContents.h"
#include "presence/BeatPace.h"
#include "presence/Introductions.h"
#include "presence/OriginTable.h"
#include "presence/PeerTable.h"
#include "presence/PresenceInbox.h"
#include "presence/ReaderWatch.h"
#include "presence/RecentProblems.h"
#include "presence/RemoteQueues.h"
#include "wire/BeatExtensions.h"
#include "wire/BeatFormat.h"

namespace Rabit
{

// Makes this node known to the others and the others known to it: sends beats, feeds those that come into the
// PeerTable, and keeps up to date what other threads read of it (OriginTable, RemoteQueues). Everything is
// sent in beats: a node that lacks something requests it in its own beats.
//
// Threads: the transport's threads only put arrivals into an inbox and wake the gateway; everything else is
// for the gateway's thread.
class Presence
{
public:
    using Duration = std::chrono::nanoseconds;

    // True if what this object knows of that node goes into the tables that other threads read.
    using SpeaksOf = std::function<bool(const std::string &node)>;

    // `wake` makes the gateway's thread call Service soon; called on any thread. References must outlive the
    // object. Of several paths that lead to a node, one `speaksOf` it.
    Presence(const std::string &node, std::uint64_t incarnation, const RabitClock &clock,
             const SourceClock &source, OriginTable &origins, RemoteQueues &remote, RandomSource random,
             PeerTable::IsNeeded isNeeded, std::function<void()> wake, SpeaksOf speaksOf);
    ~Presence();

    // This node is a tool, and requests the announcements of these nodes alone. Before Open.
    void BeTool(PeerTable::IsAsked asksOf);
    // This node plays a recording. Before Open.
    void BeReplay() { _contents.BeReplay(); }
    // States after how long other nodes are LOST (PeerTable). Before Open.
    void SetLostAfter(Duration time) { _peers.SetLostAfter(time); }
    // BeatContents::SetAgreement. Before Open.
    void SetAgreement(BeatContents::AgreementSource agreement)
    {
        _contents.SetAgreement(std::move(agreement));
    }
    // Starts to send and to receive. Throws TransportError.
    void Open(TransportSession &session, const Gateway::Announcement &announcement);
    // Says goodbye and stops.
    void Close();
    // The transport's peer handler.
    void OnPeer(const PeerEvent &event);

    // Another node's report of the queueing delay of this node's datagrams.
    struct DelayHeard
    {
        std::uint32_t Peer = 0;  // its tag (names/NodeTag.h)
        std::string Node;
        Duration Delay{0};      // of the newest datagram that had come, against the quickest
        Duration ArrivedAt{0};  // when that datagram came there, plus the way back, by this node's monotonic
                                // clock
    };

    struct Served
    {
        PeerTable::Change Change;
        // Nodes whose beats carried versions of their States: PeerTable::Peer::States.
        std::vector<std::string> StatesTold;
        // States of this node that others have requested, by index (Announcements::StateIndexOf).
        std::vector<std::size_t> StatesAsked;
        std::vector<DelayHeard> Delays;
        // Nodes whose beats tell that no datagram of this node is late, and when they sent these beats.
        std::vector<std::pair<std::uint32_t, Duration>> NothingLate;
        // Nodes whose beats told of their agreement, in order.
        struct Agreement
        {
            std::string Node;
            std::uint64_t Incarnation = 0;
            AgreementNews News;
        };
        std::vector<Agreement> Agreements;
        // Nodes that request the text of a type, and the type.
        std::vector<std::pair<std::string, BeatExtensions::TypeQuestion>> TypesAsked;

        bool Any() const
        {
            return Change.Any() || !StatesTold.empty() || !StatesAsked.empty() || !Delays.empty() ||
                   !NothingLate.empty() || !Agreements.empty() || !TypesAsked.empty();
        }
        void Clear();
    };

    // Processes the inbox; sends nothing. The returned reference is valid until the next call.
    const Served &Service(Duration now);
    // The result of the last call.
    const Served &LastServed() const { return _served; }
    // This object speaks of that node from now on.
    void Publish(const std::string &node);
    // Takes over the announcement of a node, which has come by another path. Returns true if this path lacked
    // it.
    bool Adopt(const PeerTable::Peer &elsewhere)
    {
        const bool isNew = _peers.Adopt(elsewhere);
        if (isNew && _speaksOf(elsewhere.Node))
        {
            Publish(elsewhere.Node);
        }
        return isNew;
    }
    // When to call Service again at the latest.
    Duration NextDue() const;

    // When a beat is to be sent. The scheduler of the air calls SendBeat then, for quick beats too.
    Duration BeatDue() const;
    // The time by which the last beat promised the next one.
    Duration BeatPromised() const { return _pace.Promised(); }
    // Largest size of the next beat, in bytes of its body (CDR without the encapsulation).
    std::size_t BeatSize(Duration now) const { return _contents.Size(now); }
    // BeatContents::LeastSize
    std::size_t LeastBeatSize(Duration now) const { return _contents.LeastSize(now); }
    // Number of datagrams that a beat takes.
    std::size_t BeatCopies() const;
    // Number of sessions that receive a sample sent to that node alone (TransportWriter::WriteTo): two while
    // two live nodes have its name.
    std::size_t SessionsOf(std::string_view node) const;
    // Sends exactly one beat, whose body takes at most `most` bytes, but at least those of an empty beat.
    // Contents that do not fit follow in the next beats. Returns the bytes of its body; 0 before Open.
    std::size_t SendBeat(Duration now, std::size_t most = BeatFormat::Largest);
    // Shortest beat period of a tool: nobody waits to learn that it has gone.
    static constexpr Duration ToolPeriod = std::chrono::seconds(2);
    // A tool that lacks something asks once in ToolGap, ToolQuestions times.
    static constexpr Duration ToolGap = std::chrono::milliseconds(250);
    static constexpr int ToolQuestions = 12;
    // Sets the time between beats when none is brought forward (BeatPace).
    void SetBeatPeriod(Duration period)
    {
        _pace.SetPeriod(_isTool ? std::max(period, ToolPeriod) : period);
        _contents.SetBeatPeriod(_pace.Period());
    }
    Duration BeatPeriod() const { return _pace.Period(); }

    // Sets the version of a State of this node, by index (Announcements::StateIndexOf), which the beats
    // carry. 0: never written. Only after Open.
    void SetStateVersion(std::size_t state, std::uint32_t version)
    {
        _contents.SetStateVersion(state, version);
    }
    // A State was written just now: the next beat comes soon, for nodes that the State did not reach.
    void StateWritten(Duration now) { _pace.StateWritten(now); }
    // Sets the States of that node, by index, that each beat from now on requests; none: no request. `soon`:
    // the next beat is brought forward. Holds for the present incarnation of the node.
    void WantStates(const std::string &node, const std::vector<bool> &states, bool soon, Duration now)
    {
        _contents.Questions().Set(node, states, soon, now);
    }
    // Sets the troubles of this node's links, which the beats report.
    void SetStrains(std::vector<LinkStrain> strains) { _contents.SetStrains(std::move(strains)); }
    // Sets the nodes that are heard by this path and by no better one, which the beats tell. After a change
    // the next beat comes soon.
    void SetFirstHeard(const std::vector<std::string> &nodes);
    // Sets the number of this node's problems, which the beats tell.
    void SetProblems(const ProblemCount &problems) { _contents.SetProblems(problems); }
    // The texts of types, and the reports of other nodes, that this node lacks, and its beats request.
    TypeQuestions &TypesLacking() { return _contents.Types(); }
    const TypeQuestions &TypesLacking() const { return _contents.Types(); }
    // A datagram of that node, other than a beat, came by `delay` later than its quickest; the beats report
    // that.
    void NoteDelay(std::string_view node, Duration delay, Duration arrivedAt);
    // DelayNotes::HeardLate
    void HeardLate(Duration delay) { _contents.Delays().HeardLate(delay); }
    // DelayNotes::LongDelayOnly
    Duration LongDelay(Duration now) { return _contents.Delays().LongDelayOnly(now); }

    const PeerTable &Peers() const { return _peers; }
    // Number of samples of the gateways' topics that were malformed, or found the inbox full.
    std::uint64_t Malformed() const { return _inbox.Dropped() + _peers.Malformed(); }
    // Nodes whose beats have another version.
    std::vector<Gateway::Problem> Problems(Duration now) const { return _otherFormats.Problems(now); }

private:
    void WakeIf(bool somethingCame);
    void TakeIn(const PresenceInbox::Contents &inbox, Duration now, Served &served);
    void TakeIn(const HeardBeat &heard, Duration now, Served &served);
    void TakeIn(const PeerEvent &event, Duration now, Served &served);
    void TakeQuestions(const HeardBeat &heard, Duration now, Served &served);
    void TakeDelays(const HeardBeat &heard, const PeerTable::Peer &peer, Served &served) const;
    void Note(const PeerTable::Change &change, const std::string &node, Served &served);
    void Publish(const PeerTable::Peer &peer, bool offers);
    std::size_t OthersThan(const std::string &node) const;
    Gateway::Beat MakeBeat(const PostTime &time) const;
    WriteResult Write(const Gateway::Beat &beat, const PostTime &time);

    const std::string _node;
    const std::uint32_t _tag;
    const RabitClock &_clock;
    const SourceClock _source;
    OriginTable &_origins;
    RemoteQueues &_remote;
    const std::function<void()> _wake;
    const SpeaksOf _speaksOf;

    PeerTable _peers;
    Introductions _introductions;
    ReaderWatch _watch;
    Served _served;
    Duration _lookAt{0};  // when to look at the matched readers next
    BeatPace _pace;
    BeatContents _contents;
    bool _isTool = false;
    bool _owesNews = false;                  // a large delay, to be reported before the next beat is due
    std::vector<std::uint32_t> _firstHeard;  // tags
    RecentProblems _otherFormats;
    PresenceInbox _inbox;

    std::unique_ptr<TransportWriter> _writer;
    std::unique_ptr<TransportReader> _reader;
};

}  // namespace Rabit
