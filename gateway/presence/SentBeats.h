#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace Rabit
{

// The beats that this node has sent lately, so that an echo of any other beat is ignored. Bounded: the newest
// 256, two minutes of them at the usual period.
class SentBeats
{
public:
    // A beat with the source time `source` was sent when the monotonic clock showed `at`.
    void Add(std::int64_t source, std::chrono::nanoseconds at)
    {
        _beats[_next++ % _beats.size()] = {static_cast<std::uint32_t>(source), at};
    }

    // When the beat was sent whose source time has the lower 32 bits `beat`; empty: no such beat.
    std::optional<std::chrono::nanoseconds> Find(std::uint32_t beat) const
    {
        for (std::size_t i = 1; i <= _beats.size() && i <= _next; ++i)
        {
            const Sent &sent = _beats[(_next - i) % _beats.size()];
            if (sent.Beat == beat)
            {
                return sent.At;
            }
        }
        return std::nullopt;
    }

private:
    struct Sent
    {
        std::uint32_t Beat = 0;
        std::chrono::nanoseconds At{0};
    };

    std::array<Sent, 256> _beats{};
    std::size_t _next = 0;
};

}  // namespace Rabit
