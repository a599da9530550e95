#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "envelope/Types.h"

namespace Rabit::Envelope
{

// Bounds the processor time of work that others cause. Each piece is charged a fixed cost, so that no clock
// of the processor is read. Time is passed in. Not thread-safe.
class ProcessorBudget
{
public:
    // Of verifying one signature, and of naming a session, deriving one key and trying it, on a small
    // processor of 2020. A faster one spends less than its budget.
    static constexpr std::chrono::microseconds Signature{110};
    static constexpr std::chrono::microseconds Derivation{10};
    // A datagram leads to a question, or to a row of problems.
    static constexpr std::chrono::microseconds Reaction{10};

    // `share`: processor time for each second. As much may be spent at once. `cost`: of one piece of work.
    ProcessorBudget(std::chrono::microseconds share, std::chrono::microseconds cost)
        : _share(share), _cost(cost), _left(share)
    {
    }

    // Returns false if less than one piece's cost is left. Else charges it.
    bool Take(TimePoint now)
    {
        const bool has = HasLeft(now);
        _left -= has ? _cost : std::chrono::microseconds(0);
        return has;
    }

    // True if Take would return true.
    bool HasLeft(TimePoint now)
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
        return _left >= _cost;
    }

private:
    std::chrono::microseconds _share;
    std::chrono::microseconds _cost;
    std::chrono::nanoseconds _left;
    TimePoint _filled{};
};

}  // namespace Rabit::Envelope
