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
#include "presence/OtherFormats.h"
#include "presence/PeerTable.h"
#include "presence/PresenceInbox.h"
#include "presence/ReaderWatch.h"
#include "presence/RemoteQueues.h"
#include "wire/BeatExtensions.h"
#include "wire/BeatFormat.h"

namespace Rabit
{

// Makes this node known to the others and the others known to it: sends beats, feeds those that come into the
// PeerTable, and keeps up to date what other threads read of it (OriginTable, RemoteQueues). All that it says
// goes with beats: who lacks something asks for it in its own ones.
//
// Threads: the transport's threads only leave what has come in an inbox and wake the gateway; everything else
// is for the gateway's thread.
class Presence
{
public:
    using Duration = std::chrono::nanoseconds;

    // `wake` makes the gateway's thread call Service soon; called on any thread. References must outlive the
    // object.
    Presence(const std::string &node, std::uint64_t incarnation, const RabitClock &clock,
             const SourceClock &source, OriginTable &origins, RemoteQueues &remote, RandomSource random,
             PeerTable::IsNeeded isNeeded, std::function<void()> wake);
    ~Presence();

    // This node is a tool, and asks for the announcements of these nodes alone. Before Open.
    void BeTool(PeerTable::IsAsked asksOf);
    // What this node posts was recorded before. Before Open.
    void BeReplay() { _contents.BeReplay(); }
    // Starts to send and to receive. Throws TransportError.
    void Open(TransportSession &session, const Gateway::Announcement &announcement);
    // Says goodbye and stops.
    void Close();
    // The transport's peer handler.
    void OnPeer(const PeerEvent &event);

    // What another node says of how late this node's datagrams come to it.
    struct DelayHeard
    {
        std::uint32_t Peer = 0;  // its tag (names/NodeTag.h)
        std::string Node;
        Duration Delay{0};      // of the newest that had come, against the quickest
        Duration ArrivedAt{0};  // when it came there, and the way back, by this node's monotonic clock
    };

    struct Served
    {
        PeerTable::Change Change;
        // Nodes whose beats have told of their States: PeerTable::Peer::States.
        std::vector<std::string> StatesTold;
        // States of this node that others have asked for, by their places (Announcements::StateIndexOf).
        std::vector<std::size_t> StatesAsked;
        std::vector<DelayHeard> Delays;
        // Tags of those whose beats say nothing of how late this node's datagrams come.
        std::vector<std::uint32_t> NothingLate;
        // Who asks for which text of a type.
        std::vector<std::pair<std::string, BeatExtensions::TypeQuestion>> TypesAsked;

        bool Any() const
        {
            return Change.Any() || !StatesTold.empty() || !StatesAsked.empty() || !Delays.empty() ||
                   !NothingLate.empty() || !TypesAsked.empty();
        }
        void Clear();
    };

    // Takes in what has come; sends nothing. What is returned holds until the next call.
    const Served &Service(Duration now);
    // When to call Service again at the latest.
    Duration NextDue() const;

    // When a beat is to be sent; whoever decides what goes on the air next calls SendBeat then. All beats go
    // this way, the quick ones too.
    Duration BeatDue() const;
    // By when the last beat has promised the next one.
    Duration BeatPromised() const { return _pace.Promised(); }
    // What the next beat takes at most, as the bytes of its body (CDR without the encapsulation).
    std::size_t BeatSize(Duration now) const { return _contents.Size(now); }
    // How many datagrams it takes.
    std::size_t BeatCopies() const;
    // How many sessions get what is sent to that node alone (TransportWriter::WriteTo): two while two live
    // nodes have its name.
    std::size_t SessionsOf(std::string_view node) const;
    // Sends exactly one beat, whose body takes at most so many bytes, but always what an empty one takes; the
    // rest of what is to be said follows in the next ones. Returns the bytes of its body; 0 before Open.
    std::size_t SendBeat(Duration now, std::size_t most = BeatFormat::Largest);
    static constexpr std::size_t LargestBeat = BeatFormat::Largest;
    // Of a tool, at least: nobody waits to learn that it has gone.
    static constexpr Duration ToolPeriod = std::chrono::seconds(2);
    // While a tool lacks something it asks so often, so often.
    static constexpr Duration ToolGap = std::chrono::milliseconds(250);
    static constexpr int ToolQuestions = 12;
    // How often this node beats when nothing is the matter (BeatPace).
    void SetBeatPeriod(Duration period)
    {
        _pace.SetPeriod(_isTool ? std::max(period, ToolPeriod) : period);
        _contents.SetBeatPeriod(_pace.Period());
    }
    Duration BeatPeriod() const { return _pace.Period(); }

    // The version of a State of this node, by its place (Announcements::StateIndexOf), for the beats to tell.
    // 0: never written. Only after Open.
    void SetStateVersion(std::size_t state, std::uint32_t version)
    {
        _contents.SetStateVersion(state, version);
    }
    // One was written just now: the next beat comes soon, for those whom it did not reach.
    void StateWritten(Duration now) { _pace.StateWritten(now); }
    // The States of that node, by their places, that are to be asked for in each beat from now on; none:
    // nothing is. `soon`: the next beat is brought forward. Holds for the present life of the node.
    void WantStates(const std::string &node, const std::vector<bool> &states, bool soon, Duration now)
    {
        _contents.Questions().Set(node, states, soon, now);
    }
    // What this node's links suffer from, for the beats to say.
    void SetStrains(std::vector<LinkStrain> strains) { _contents.SetStrains(std::move(strains)); }
    // The texts of types that are lacking, for the beats to ask for.
    TypeQuestions &TypesLacking() { return _contents.Types(); }
    const TypeQuestions &TypesLacking() const { return _contents.Types(); }
    // A datagram of that node that is no beat came so much later than its quickest, for the beats to tell.
    void NoteDelay(std::string_view node, Duration delay, Duration arrivedAt);

    const PeerTable &Peers() const { return _peers; }
    // Samples of the gateways' topics that made no sense, or came faster than they could be taken in.
    std::uint64_t Malformed() const { return _inbox.Dropped() + _peers.Malformed(); }
    // Nodes that cannot be understood.
    std::vector<Gateway::Problem> Problems(Duration now) const { return _otherFormats.Problems(now); }

private:
    void WakeIf(bool somethingCame);
    void TakeIn(const PresenceInbox::Contents &inbox, Duration now, Served &served);
    void TakeIn(const HeardBeat &heard, Duration now, Served &served);
    void TakeIn(const PeerEvent &event, Duration now, Served &served);
    void TakeQuestions(const HeardBeat &heard, Duration now, Served &served);
    void TakeDelays(const HeardBeat &heard, const PeerTable::Peer &peer, Served &served) const;
    void Note(const PeerTable::Change &change, const std::string &node, Served &served);
    void Publish(const std::string &node, const PeerTable::Change &change);
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

    PeerTable _peers;
    Introductions _introductions;
    ReaderWatch _watch;
    Served _served;
    Duration _lookAt{0};  // at the readers
    BeatPace _pace;
    BeatContents _contents;
    bool _isTool = false;
    bool _owesNews = false;  // of a delay, to be told before the next beat is due
    OtherFormats _otherFormats;
    PresenceInbox _inbox;

    std::unique_ptr<TransportWriter> _writer;
    std::unique_ptr<TransportReader> _reader;
};

}  // namespace Rabit
