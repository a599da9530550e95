#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace Rabit
{

// How much a session's discovery may say (TransportSession::SetDiscoveryRate), and whether it says less than
// it has to (TransportSession::DiscoveryHeldUp), for whichever of the vendor's sessions there is now.
// Thread-safe.
class DiscoveryPace
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    static constexpr std::size_t MostLate = 16;

    void Set(double bytesPerSecond) { _bytesPerSecond = bytesPerSecond; }
    double Get() const { return _bytesPerSecond; }

    // TransportSession::CameLate. The newest are kept until they are taken: the air as it is.
    void CameLate(std::chrono::nanoseconds delay)
    {
        const std::lock_guard lock(_mutex);
        if (_late.size() == MostLate)
        {
            _late.pop_front();
        }
        _late.push_back(delay);
    }
    // In the order in which they came.
    std::deque<std::chrono::nanoseconds> TakeLate()
    {
        const std::lock_guard lock(_mutex);
        return std::exchange(_late, {});
    }

    // What is to go next has been held up since then; empty: nothing is.
    void SetHeldUpSince(std::optional<TimePoint> since) { _heldUpSince = since.value_or(TimePoint{}); }
    std::chrono::nanoseconds HeldUp(TimePoint now) const
    {
        const TimePoint since = _heldUpSince;
        return since == TimePoint{} || since > now ? std::chrono::nanoseconds(0) : now - since;
    }

private:
    std::atomic<double> _bytesPerSecond{0.0};
    std::mutex _mutex;
    std::deque<std::chrono::nanoseconds> _late;  // guarded by _mutex
    std::atomic<TimePoint> _heldUpSince{TimePoint{}};
};

}  // namespace Rabit
