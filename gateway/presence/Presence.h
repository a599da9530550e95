#pragma once

#include <rabit/RabitClock.h>
#include <rabit/gateway/RandomSource.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "clocks/SourceClock.h"
#include "gateway.idl.h"
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

    struct Served
    {
        PeerTable::Change Change;
        // Somebody has come that can use what this node publishes, and now is the time to repeat it.
        bool RepeatStates = false;
    };

    // Takes in what has come and sends what is due.
    Served Service(Duration now);
    // When to call Service again at the latest.
    Duration NextDue() const;

    const PeerTable &Peers() const { return _peers; }
    // Samples of the gateways' topics that made no sense, or came faster than they could be taken in.
    std::uint64_t Malformed() const { return _inbox.Dropped(); }

private:
    void WakeIf(bool somethingCame);
    PeerTable::Change TakeIn(const PresenceInbox::Contents &inbox, Duration now);
    void Publish(const std::string &node);
    void Introduce();
    std::size_t OthersThan(const std::string &node) const;
    void SendBeat(Duration now);
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
    Duration _nextBeat{0};
    Duration _beatStep = PeerTable::BeatPeriod;  // from one beat to the next
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
