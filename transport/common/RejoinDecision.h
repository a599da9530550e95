// Decides when a session joins the network anew because the host's networks have changed since it was opened.
// The vendors do not follow such changes. Joining anew costs all matches and histories, so it is done rarely
// and only for a gain.
//
// - A usable network that the session was not opened with is joined when it has lasted for Settle. Each time
//   the interface vanished within Memory doubles that time, up to LongestSettle.
// - A network of the session that returns with the same interface and address needs nothing.
// - A network that vanishes needs nothing either, with two exceptions. A peer on it that is also on another
//   network of the session, or on none (behind a router), may send to the old address: the session joins anew
//   without the network after LostFor. If no network of the session has its address any more, loopback is
//   joined after LostFor, for the other processes of this host.
// - A network of the session that is still present but not to be used any more is left.
// - Spacing separates two joins; after a failed one Retry applies, which doubles up to LongestRetry.
//
// Pure: no thread, no clock, no system call.
#pragma once

#include <rabit/base/Backoff.h>

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

    // The host's networks and the known peers now.
    struct View
    {
        const std::vector<HostNetwork> &Host;    // all networks of this host
        const std::vector<HostNetwork> &Usable;  // those that the session is to use
        const std::vector<PeerPlace> &Peers;     // those that the session knows
        bool PeersResolved = false;  // a peer's name has got an address since the session was opened
    };

    struct Verdict
    {
        bool Join = false;
        std::string Why;                 // for the log, if Join
        std::optional<TimePoint> Again;  // when to look again, even if nothing changes; set only if not Join
    };

    explicit RejoinDecision(const RejoinTimes &times = {}) : _times(times) {}

    // Call whenever something may have changed.
    Verdict Look(TimePoint now, const View &view);
    // The session was opened with these networks.
    void Joined(TimePoint now, std::vector<HostNetwork> with);
    // The session was closed, or could not be opened.
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
    // When the session is to join because of `network`, which it was not opened with.
    std::optional<TimePoint> DueFor(const HostNetwork &network) const;
    bool IsMissed(const HostNetwork &gone, const View &view) const;
    TimePoint Spaced(TimePoint due) const;

    const RejoinTimes _times;
    bool _isJoined = false;
    std::vector<HostNetwork> _with;
    std::optional<TimePoint> _lastJoin;
    std::optional<TimePoint> _retryAt;
    Backoff _retry{{_times.Retry, _times.LongestRetry}};
    std::map<Key, Seen> _usable;                             // the usable networks now
    std::map<std::string, std::deque<TimePoint>> _vanished;  // by interface: when it vanished, within Memory
    std::map<Key, TimePoint> _gone;     // networks of _with without a carrier or worse: since when
    std::optional<TimePoint> _allGone;  // since when no address of _with is present
};

}  // namespace Rabit
