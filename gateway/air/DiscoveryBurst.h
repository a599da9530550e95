#pragma once

#include <chrono>
#include <cstddef>

namespace Rabit
{

// Detects the end of a burst of DDS discovery. A new node makes every node send much discovery data, which
// fills a thin radio for seconds. The delays meanwhile tell nothing about the capacity afterwards.
//
// A burst begins when more than Many bytes of discovery went within a second, and is over after a second with
// less than Few. Pure; `now` never goes back.
class DiscoveryBurst
{
public:
    using Duration = std::chrono::nanoseconds;
    static constexpr std::size_t Many = 1500;
    static constexpr std::size_t Few = 400;

    // `bytes` bytes of discovery were sent since the last call. Call it also with 0. Returns true once when a
    // burst is over.
    bool IsOverAfter(std::size_t bytes, Duration now)
    {
        _bytes += bytes;
        _is = _is || _bytes > Many;
        if (now - _since < std::chrono::seconds(1))
        {
            return false;
        }
        const bool over = _is && _bytes < Few;
        _is = _is && !over;
        _since = now;
        _bytes = 0;
        return over;
    }

private:
    Duration _since{0};
    std::size_t _bytes = 0;
    bool _is = false;
};

}  // namespace Rabit
