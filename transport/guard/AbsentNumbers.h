// The numbers of one writer that the vendor may be told to be absent.
#pragma once

#include <cstdint>
#include <optional>

#include "guard/WalkBudget.h"

namespace Rabit::Rtps
{

// Heartbeats and gaps declare numbers absent. The vendor steps through them from the last number that it has,
// which this class knows from its acknowledgements. A heartbeat or a gap is cut to the steps that WalkBudget
// grants. The vendor then requests the next numbers, and the writer declares them absent again. So no honest
// range is lost, however wide it is. A range that is not cut costs nothing. Not thread-safe.
class AbsentNumbers
{
public:
    using TimePoint = WalkBudget::TimePoint;

    // Numbers of a gap behind a missing sample. The vendor keeps an entry of 56 bytes for each.
    static constexpr std::int64_t FewAhead = 64;

    // As a gap has it (9.4.5.6): all numbers from First on are absent up to the one before Base. A list of
    // single numbers from Base on follows, up to Last.
    struct Gap
    {
        std::int64_t First = 0;
        std::int64_t Base = 0;
        std::int64_t Last = 0;
    };

    // The writer was announced. The vendor may have forgotten it before, and then begins at its first number.
    // Until it acknowledges a number, it gets the free steps alone.
    void Announced()
    {
        _walked = 0;
        _isSure = false;
    }
    // The vendor acknowledges all numbers before `base`.
    void Acknowledged(std::int64_t base)
    {
        _walked = base > 0 ? base - 1 : 0;
        _isSure = true;
    }
    // The vendor gets this sample, whole.
    void Given(std::int64_t number) { _walked += number == _walked + 1 ? 1 : 0; }

    // The first number that a heartbeat may name: all before it are absent.
    std::int64_t FirstOf(std::int64_t first, WalkBudget &budget, TimePoint now);
    // The part of a gap that the vendor may get: if its Base is lower, without the list. Empty: nothing.
    std::optional<Gap> PartOf(Gap gap, WalkBudget &budget, TimePoint now);

private:
    // Steps to `last` as far as is granted. Returns the number that was reached.
    std::int64_t WalkTo(std::int64_t last, WalkBudget &budget, TimePoint now);

    std::int64_t _walked = 0;  // the vendor has all numbers up to here, or has stepped through them
    bool _isSure = false;      // the vendor has acknowledged something since the announcement
};

}  // namespace Rabit::Rtps
