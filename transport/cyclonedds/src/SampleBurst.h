#pragma once

#include <chrono>
#include <cstddef>

namespace Rabit::Cyclone
{

// Spreads a large sample of a session with a member over time. The vendor sends its fragments as fast as they
// are sealed. A receiver may open them more slowly, and its socket's buffer holds 3.4 MB of them where the
// system allows 4 MiB. A State is written with best effort, so one fragment that the buffer drops costs the
// whole sample.
//
// One for each sending thread. A pure state machine.
class SampleBurst
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // 32 MB/s at most. The pause lets a receiver on the same processor run.
    static constexpr std::size_t Largest = 64 * 1024;
    static constexpr std::chrono::milliseconds Pause{2};

    // The thread has sent a datagram of a sample. Returns how long it should wait before the next.
    std::chrono::milliseconds Sent(std::size_t bytes, TimePoint now)
    {
        _bytes = (now - _last >= Pause ? 0 : _bytes) + bytes;
        _last = now;
        if (_bytes < Largest)
        {
            return std::chrono::milliseconds(0);
        }
        _bytes = 0;
        return Pause;
    }

private:
    TimePoint _last{};
    std::size_t _bytes = 0;
};

}  // namespace Rabit::Cyclone
