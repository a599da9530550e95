// When a session is to join the network anew, because the host's networks are not those that it was opened
// with. Neither vendor follows such a change, and joining anew costs everybody's matches and histories: so it
// is done when it gains something, and seldom.
//
//   - A usable network that the session was not opened with is joined when it has lasted for Settle. Each
//     time that an interface was there and went within Memory doubles that for it, up to LongestSettle.
//   - A network of the session that comes back as it was (same interface, same address) needs nothing.
//   - A network that goes needs nothing either, with two exceptions. If a peer was on it that is on another
//     network of the session too, or that is on none (behind a router), that peer may go on to send to the
//     address that is gone: the session joins anew without it after LostFor. And if no network of the session
//     has its address any more, loopback is joined after LostFor, for the other processes of this host.
//   - A network of the session that is not to be used any more, though it is there, is left.
//   - Between two times there is Spacing; after one that failed, Retry, which doubles up to LongestRetry.
//
// Pure: no thread, no clock, no system call.
#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/HostNetworks.h"
#include "common/PeerPlace.h"

namespace Rabit
{

struct RejoinTimes
{
    std::chrono::milliseconds Settle{250};
    std::chrono::milliseconds LongestSettle{30000};
    std::chrono::milliseconds Memory{60000};
    std::chrono::milliseconds LostFor{2000};
    std::chrono::milliseconds Spacing{1000};
    std::chrono::milliseconds Retry{1000};
    std::chrono::milliseconds LongestRetry{4000};
};

class RejoinDecision
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // What is there now.
    struct View
    {
        const std::vector<HostNetwork> &Host;    // all
        const std::vector<HostNetwork> &Usable;  // those of them that the session is to use
        const std::vector<PeerPlace> &Peers;     // that the session knows
        bool PeersResolved = false;  // a peer's name has got an address since the session was opened
    };

    struct Verdict
    {
        bool Join = false;
        std::string Why;                 // for the log, if Join
        std::optional<TimePoint> Again;  // when to look again, even if nothing changes; if not Join
    };

    explicit RejoinDecision(const RejoinTimes &times = {}) : _times(times) {}

    // To be called whenever something may have changed.
    Verdict Look(TimePoint now, const View &view);
    // The session was opened with these networks.
    void Joined(TimePoint now, std::vector<HostNetwork> with);
    // It was closed, or could not be opened.
    void Failed(TimePoint now);

private:
    using Key = std::pair<unsigned, std::string>;  // interface's index, address

    struct Seen
    {
        std::string Interface;
        TimePoint Since;
    };

    static Key KeyOf(const HostNetwork &network) { return {network.Index, network.Address}; }

    void Follow(TimePoint now, const View &view);
    std::chrono::milliseconds SettleOf(const std::string &interface) const;
    // When the session is to join for the sake of that network, which it was not opened with.
    std::optional<TimePoint> DueFor(const HostNetwork &network) const;
    bool IsMissed(const HostNetwork &gone, const View &view) const;
    TimePoint Spaced(TimePoint due) const;

    const RejoinTimes _times;
    bool _isJoined = false;
    std::vector<HostNetwork> _with;
    std::optional<TimePoint> _lastJoin;
    std::optional<TimePoint> _retryAt;
    std::chrono::milliseconds _retry{0};
    std::map<Key, Seen> _usable;                             // now
    std::map<std::string, std::deque<TimePoint>> _vanished;  // interface: when, within Memory
    std::map<Key, TimePoint> _gone;                          // of _with: since when without carrier or worse
    std::optional<TimePoint> _allGone;                       // since when no address of _with is there
};

}  // namespace Rabit
