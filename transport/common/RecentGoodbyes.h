// Remembers the participants that said goodbye.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>

#include "common/RecentMap.h"
#include "common/Rtps.h"

namespace Rabit::Rtps
{

// A goodbye overtakes announcements that were sent before it on another socket, by milliseconds. The
// participant must not come back by them. But a goodbye may be forged, also where nodes have keys: nothing in
// it is signed. So a participant is accepted again if it still announces itself later. Times are those of the
// receipt, so a session that shares the guard's goodbyes drops no announcement that the guard has let through
// after one: implementations report a participant once. Bounded: a full table forgets the oldest.
// Thread-safe.
class RecentGoodbyes
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // How long announcements behind a goodbye are ignored.
    static constexpr std::chrono::seconds Overtaken{2};
    // As many as the guard knows participants (KnownPeers).
    static constexpr std::size_t Most = 1024;

    // A repeated goodbye does not count, so that repetitions cannot keep a participant away for longer.
    void Note(const GuidPrefix &peer, TimePoint now)
    {
        const std::lock_guard lock(_mutex);
        if (!IsNoted(peer, now))
        {
            _goodbyes.Put(peer, now);
        }
    }
    bool Has(const GuidPrefix &peer, TimePoint now) const
    {
        const std::lock_guard lock(_mutex);
        return IsNoted(peer, now);
    }

private:
    bool IsNoted(const GuidPrefix &peer, TimePoint now) const
    {
        const TimePoint *const at = _goodbyes.Find(peer);
        return at != nullptr && now - *at < Overtaken;
    }

    mutable std::mutex _mutex;
    RecentMap<GuidPrefix, TimePoint> _goodbyes{Most};  // guarded by _mutex
};

}  // namespace Rabit::Rtps
