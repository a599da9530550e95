#include "guard/AbsentNumbers.h"

#include <algorithm>

namespace Rabit::Rtps
{

std::int64_t AbsentNumbers::WalkTo(std::int64_t last, WalkBudget &budget, TimePoint now)
{
    const std::int64_t wanted = std::max(last - _walked, std::int64_t{0});
    _walked += _isSure ? budget.Take(wanted, now) : std::min(wanted, WalkBudget::Free);
    return _walked;
}

std::int64_t AbsentNumbers::FirstOf(std::int64_t first, WalkBudget &budget, TimePoint now)
{
    return std::min(first, WalkTo(first - 1, budget, now) + 1);
}

std::optional<AbsentNumbers::Gap> AbsentNumbers::PartOf(Gap gap, WalkBudget &budget, TimePoint now)
{
    if (gap.First > _walked + 1)
    {
        // The vendor requests it again when it has the samples before.
        return gap.Last <= _walked + FewAhead ? std::optional(gap) : std::nullopt;
    }
    // The vendor would step through numbers that it has, too.
    gap.First = std::min(_walked + 1, gap.Base);
    gap.Base = std::min(gap.Base, WalkTo(gap.Base - 1, budget, now) + 1);
    return gap;
}

}  // namespace Rabit::Rtps
