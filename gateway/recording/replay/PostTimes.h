#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace Rabit::Replay
{

// When a message that is played is said to have been posted: as long ago as it was old when it was recorded.
// But a receiver takes nothing that was posted before what it has: what would be is said to have been posted
// just after it, and is younger there than it was.
class PostTimes
{
public:
    using Duration = std::chrono::nanoseconds;
    // Between two posts of one stream; receivers tell them apart by it.
    static constexpr Duration Least = std::chrono::microseconds(2);

    explicit PostTimes(std::size_t streams) : _last(streams) {}

    // By the clock that shows `now`.
    Duration Of(std::size_t stream, Duration now, Duration age)
    {
        std::optional<Duration> &last = _last.at(stream);
        const Duration wanted = now - std::max(age, Duration(0));
        const Duration posted = last ? std::max(wanted, *last + Least) : wanted;
        _notKept += posted > wanted + Tolerance ? 1 : 0;
        last = posted;
        return posted;
    }
    // Nobody has anything of it any more: its node begins a new life.
    void Forget(std::size_t stream) { _last.at(stream).reset(); }
    // Messages that came out younger than they were, by more than a millisecond.
    std::uint64_t NotKept() const { return _notKept; }

private:
    static constexpr Duration Tolerance = std::chrono::milliseconds(1);

    std::vector<std::optional<Duration>> _last;  // by stream
    std::uint64_t _notKept = 0;
};

}  // namespace Rabit::Replay
