#pragma once

#include <chrono>
#include <cstddef>

namespace Rabit
{

// When DDS has made acquaintances: a node that comes makes every node say a lot, and on a thin radio that is
// all that the air carries for seconds. How late datagrams come meanwhile tells nothing of what it carries
// for what follows.
//
// A burst begins when more than Many bytes of discovery went within a second, and is over after a second with
// less than Few. Pure; `now` never goes back.
class DiscoveryBurst
{
public:
    using Duration = std::chrono::nanoseconds;
    static constexpr std::size_t Many = 1500;
    static constexpr std::size_t Few = 400;

    // So many bytes of discovery went since the last call. Call it also with 0. True: a burst is over, said
    // once.
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
