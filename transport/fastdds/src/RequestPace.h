#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "OutgoingMessage.h"

namespace Rabit::FastDds
{

// Decides when a first request goes out again. The vendor repeats it every 10 or 70 ms until the writer
// answers, for as long as the peer's lease: 2.6 kB/s for each pair over a one-way path. Here the intervals of
// repetitions double. Held requests are not lost, since the vendor repeats them. A pure state machine, not
// thread-safe.
class RequestPace
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // A first request to a discovery writer waits this long, because the peer often sends its discovery by
    // itself.
    static constexpr std::chrono::milliseconds Patience{100};
    static constexpr std::chrono::milliseconds FirstGap{50};
    static constexpr std::chrono::milliseconds LongestGap{2000};
    // A request after a pause of this length is a new one.
    static constexpr std::chrono::milliseconds Rest{1000};
    static constexpr std::size_t MostRequests = 4096;

    // `socket`: number of the socket. The same request may go through several.
    bool MayGo(std::uint32_t socket, const FirstRequest &request, TimePoint now);
    std::size_t Size() const { return _asked.size(); }

private:
    struct Asked
    {
        TimePoint Last;  // when the vendor last sent it
        TimePoint Next;  // when it may go again
        Backoff Gap{{FirstGap, LongestGap}};
    };

    std::map<std::pair<std::uint32_t, FirstRequest>, Asked> _asked;
};

}  // namespace Rabit::FastDds
