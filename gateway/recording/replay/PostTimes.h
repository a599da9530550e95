#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace Rabit::Replay
{

// Gives replayed messages their post times, so that each is as old as when it was recorded. But a receiver
// ignores a message that was posted before the one that it has. Such a message gets a post time just after
// that one, and is younger than it was.
class PostTimes
{
public:
    using Duration = std::chrono::nanoseconds;
    // Between the post times of two messages of one stream, so that receivers can tell them apart.
    static constexpr Duration Least = std::chrono::microseconds(2);

    explicit PostTimes(std::size_t streams) : _last(streams) {}

    // Returns the post time of a message of that age, by the clock of `now`.
    Duration Of(std::size_t stream, Duration now, Duration age)
    {
        std::optional<Duration> &last = _last.at(stream);
        const Duration wanted = now - std::max(age, Duration(0));
        const Duration posted = last ? std::max(wanted, *last + Least) : wanted;
        _notKept += posted > wanted + Tolerance ? 1 : 0;
        last = posted;
        return posted;
    }
    // Forgets a stream: its node begins a new life, so no receiver has a message of it.
    void Forget(std::size_t stream) { _last.at(stream).reset(); }
    // Number of messages that became younger than they were by more than a millisecond.
    std::uint64_t NotKept() const { return _notKept; }

private:
    static constexpr Duration Tolerance = std::chrono::milliseconds(1);

    std::vector<std::optional<Duration>> _last;  // by stream
    std::uint64_t _notKept = 0;
};

}  // namespace Rabit::Replay
