#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "envelope/Types.h"

namespace Rabit::Envelope
{

// Bounds the processor time that signatures of senders take which have not proven that they are live. A
// signature is charged a fixed cost, so that no clock of the processor is read. Time is passed in. Not
// thread-safe.
class SignatureBudget
{
public:
    // Of verifying one signature, on a small processor of 2020; a faster one spends less than its budget.
    static constexpr std::chrono::microseconds Cost{110};

    // `share`: processor time for each second. As much may be spent at once.
    explicit SignatureBudget(std::chrono::microseconds share) : _share(share), _left(share) {}

    // Returns false if less than one signature's cost is left. Else charges it.
    bool Take(TimePoint now)
    {
        const auto passed =
            std::clamp<TimePoint::duration>(now - _filled, TimePoint::duration(0), std::chrono::seconds(1));
        constexpr std::int64_t MicrosecondsInASecond = 1'000'000;
        const std::chrono::nanoseconds earned(std::chrono::nanoseconds(passed).count() * _share.count() /
                                              MicrosecondsInASecond);
        if (now > _filled)
        {
            _left = std::min<std::chrono::nanoseconds>(_left + earned, _share);
            _filled = now;
        }
        if (_left < Cost)
        {
            return false;
        }
        _left -= Cost;
        return true;
    }

private:
    std::chrono::microseconds _share;
    std::chrono::nanoseconds _left;
    TimePoint _filled{};
};

}  // namespace Rabit::Envelope
