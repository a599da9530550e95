// Remembers the participants that said goodbye.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>

#include "common/RecentMap.h"
#include "common/Rtps.h"

namespace Rabit::Rtps
{

// A goodbye overtakes announcements that were sent before it, on another socket by milliseconds, on a full
// channel by seconds. The participant must not come back by them. But a goodbye may be forged. So a
// participant is accepted again if it goes on: datagrams that were held up come together, and those of a
// living participant come again and again. Times are those of the receipt, so a session that shares the
// guard's goodbyes drops no announcement that the guard has let through after one: implementations report a
// participant once. Bounded: a full table forgets the oldest. Thread-safe.
class RecentGoodbyes
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // How long announcements behind a goodbye are ignored.
    static constexpr std::chrono::seconds Overtaken{2};
    // A participant goes on if it is heard again this long after its first datagram behind that time. A queue
    // that holds the datagrams of two seconds and more is one on which a goodbye is late, too.
    static constexpr std::chrono::seconds GoesOn{2};
    // As many as the guard knows participants (KnownPeers).
    static constexpr std::size_t Most = 1024;

    // A repeated goodbye does not count, so that repetitions cannot keep a participant away for longer.
    void Note(const GuidPrefix &peer, TimePoint now)
    {
        const std::lock_guard lock(_mutex);
        if (!IsNoted(peer, now))
        {
            _goodbyes.Put(peer, {.At = now});
            _isEmpty = false;
        }
    }
    bool Has(const GuidPrefix &peer, TimePoint now) const
    {
        const std::lock_guard lock(_mutex);
        return IsNoted(peer, now);
    }
    // A datagram of the participant came. Returns true if the participant has said no goodbye, or goes on
    // after it; then the goodbye is forgotten.
    bool Heard(const GuidPrefix &peer, TimePoint now)
    {
        if (_isEmpty)
        {
            return true;
        }
        const std::lock_guard lock(_mutex);
        const Goodbye *const found = _goodbyes.Find(peer);
        if (found == nullptr)
        {
            return true;
        }
        if (now - found->At < Overtaken)
        {
            return false;
        }
        if (found->HeardAgain && now - *found->HeardAgain >= GoesOn)
        {
            _goodbyes.Erase(peer);
            _isEmpty = _goodbyes.Size() == 0;
            return true;
        }
        if (!found->HeardAgain)
        {
            _goodbyes.Put(peer, {.At = found->At, .HeardAgain = now});
        }
        return false;
    }

private:
    struct Goodbye
    {
        TimePoint At{};
        std::optional<TimePoint> HeardAgain{};  // the first datagram behind `Overtaken`
    };

    bool IsNoted(const GuidPrefix &peer, TimePoint now) const
    {
        const Goodbye *const found = _goodbyes.Find(peer);
        return found != nullptr && now - found->At < Overtaken;
    }

    mutable std::mutex _mutex;
    RecentMap<GuidPrefix, Goodbye> _goodbyes{Most};  // guarded by _mutex
    std::atomic<bool> _isEmpty{true};                // _goodbyes; most datagrams come while it is
};

}  // namespace Rabit::Rtps
