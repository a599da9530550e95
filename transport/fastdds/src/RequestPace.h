#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "OutgoingMessage.h"

namespace Rabit::FastDds
{

// Decides when a first request goes out again. The vendor repeats it every 10 or 70 ms until the writer
// answers, for as long as the peer's lease: over a path that carries one way alone that is 2.6 kB/s for each
// pair. Here repetitions follow each other at doubling distances. Since the vendor goes on asking, what is
// held is not lost. A pure state machine, not thread-safe.
class RequestPace
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // Discovery may well be asked for what it is about to say: whoever finds us addresses us.
    static constexpr std::chrono::milliseconds Patience{100};
    static constexpr std::chrono::milliseconds FirstGap{50};
    static constexpr std::chrono::milliseconds LongestGap{2000};
    // Who has not asked for so long asks for something new.
    static constexpr std::chrono::milliseconds Rest{1000};
    static constexpr std::size_t MostRequests = 4096;

    // `socket` numbers the sockets: the same request may go by several.
    bool MayGo(std::uint32_t socket, const FirstRequest &request, TimePoint now);
    std::size_t Size() const { return _asked.size(); }

private:
    struct Asked
    {
        TimePoint Last;  // time that the vendor asked
        TimePoint Next;  // time that it may
        std::chrono::milliseconds Gap{FirstGap};
        bool Waits = false;  // none has gone yet
    };

    std::map<std::pair<std::uint32_t, FirstRequest>, Asked> _asked;
};

}  // namespace Rabit::FastDds
