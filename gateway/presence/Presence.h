#pragma once

#include <rabit/RabitClock.h>
#include <rabit/gateway/RandomSource.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "clocks/SourceClock.h"
#include "gateway.idl.h"
#include "presence/BeatPace.h"
#include "presence/Introductions.h"
#include "presence/OriginTable.h"
#include "presence/PeerTable.h"
#include "presence/PresenceInbox.h"
#include "presence/RemoteQueues.h"
#include "presence/SenderCheck.h"

namespace Rabit
{

// Makes this node known to the others and the others known to it: sends beats and the announcement, feeds
// what comes into the PeerTable, and keeps up to date what other threads read of it (OriginTable,
// RemoteQueues).
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
             const SourceClock &source, OriginTable &origins, RemoteQueues &remote, SenderCheck &senders,
             RandomSource random, PeerTable::IsNeeded isNeeded, std::function<void()> wake);
    ~Presence();

    // Starts to send and to receive. Throws TransportError.
    void Open(TransportSession &session, Gateway::Announcement announcement);
    // Says goodbye and stops.
    void Close();
    // The transport's peer handler.
    void OnPeer(const PeerEvent &event);

    // What another node says of how late this node's datagrams come to it.
    struct DelayHeard
    {
        std::uint32_t Peer = 0;  // its tag (names/NodeTag.h)
        Duration Delay{0};       // of the newest that had come, against the quickest
        Duration ArrivedAt{0};   // when it came there, by this node's monotonic clock
    };

    struct Served
    {
        PeerTable::Change Change;
        // Somebody has come that can use what this node publishes, and now is the time to repeat it.
        bool RepeatStates = false;
        // Nodes whose beats have told of their States: PeerTable::Peer::States.
        std::vector<std::string> StatesTold;
        // States of this node that others have asked for, by their places (Announcements::StateIndexOf).
        std::vector<std::size_t> StatesAsked;
        std::vector<DelayHeard> Delays;
    };

    // Takes in what has come. Sends nothing but the announcement.
    Served Service(Duration now);
    // When to call Service again at the latest.
    Duration NextDue() const;

    // When a beat is to be sent; whoever decides what goes on the air next calls SendBeat then. All beats go
    // this way, the quick ones too.
    Duration BeatDue() const;
    // What the next beat takes at most, as the bytes of its body (CDR without the encapsulation).
    std::size_t BeatSize(Duration now) const;
    // Sends exactly one beat, whose body takes at most so many bytes, but always what an empty one takes; the
    // rest of what is to be said follows in the next ones. Returns the bytes that it took, 0 before Open.
    std::size_t SendBeat(Duration now, std::size_t most = LargestBeat);
    // Fits one datagram whatever the settings are.
    static constexpr std::size_t LargestBeat = 900;
    // How often this node beats when nothing is the matter (BeatPace).
    void SetBeatPeriod(Duration period) { _pace.SetPeriod(period); }
    Duration BeatPeriod() const { return _pace.Period(); }

    // The version of a State of this node, by its place (Announcements::StateIndexOf), for the beats to tell.
    // 0: never written.
    void SetStateVersion(std::size_t state, std::uint32_t version);
    // The States of that node, by their places, that are to be asked for in each beat from now on; none:
    // nothing is. The next beat is brought forward if there is something that was not asked for before. Holds
    // for the present life of the node.
    void WantStates(const std::string &node, const std::vector<bool> &states, Duration now);

    const PeerTable &Peers() const { return _peers; }
    // Samples of the gateways' topics that made no sense, or came faster than they could be taken in.
    std::uint64_t Malformed() const { return _inbox.Dropped(); }

private:
    void WakeIf(bool somethingCame);
    PeerTable::Change TakeIn(const PresenceInbox::Contents &inbox, Duration now);
    void Publish(const std::string &node);
    std::size_t OthersThan(const std::string &node) const;
    void SendAnnouncement(Duration now);

    const std::string _node;
    const std::uint64_t _incarnation;
    const RabitClock &_clock;
    const SourceClock _source;
    OriginTable &_origins;
    RemoteQueues &_remote;
    const std::function<void()> _wake;

    PeerTable _peers;
    Introductions _introductions;
    Gateway::Announcement _announcement;
    BeatPace _pace;
    std::vector<std::uint32_t> _states;                     // versions, by place
    std::map<std::string, std::vector<bool>> _wantsStates;  // by node
    // Said once, and again when somebody asks for it; the network may not take it the first time.
    Duration _nextAnnouncement{0};
    Duration _lastAnnouncement{0};
    std::uint32_t _announcementDigest = 0;

    PresenceInbox _inbox;

    std::unique_ptr<TransportWriter> _beatWriter;
    std::unique_ptr<TransportWriter> _announcementWriter;
    std::unique_ptr<TransportReader> _beatReader;
    std::unique_ptr<TransportReader> _announcementReader;
};

}  // namespace Rabit
