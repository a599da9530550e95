#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>

#include "backfill/Series.h"

namespace Rabit::Backfill
{

// A set of stamps, kept as ranges that do not touch each other.
class RangeSet
{
public:
    void Add(Range range)
    {
        if (range.IsEmpty())
        {
            return;
        }
        auto next = _ends.upper_bound(range.First);
        if (next != _ends.begin() && std::prev(next)->second >= range.First)
        {
            --next;
            range.First = next->first;
        }
        while (next != _ends.end() && next->first <= range.End)
        {
            range.End = std::max(range.End, next->second);
            next = _ends.erase(next);
        }
        _ends[range.First] = range.End;
    }

    bool Contains(Stamp stamp) const
    {
        const auto next = _ends.upper_bound(stamp);
        return next != _ends.begin() && std::prev(next)->second > stamp;
    }

    // Returns the newest range within `within` of which the set has nothing; empty: it has all.
    std::optional<Range> NewestGap(Range within) const
    {
        while (!within.IsEmpty())
        {
            const auto next = _ends.lower_bound(within.End);
            if (next == _ends.begin())
            {
                return within;
            }
            const auto [first, end] = *std::prev(next);
            if (end < within.End)
            {
                return Range{std::max(end, within.First), within.End};
            }
            within.End = first;
        }
        return std::nullopt;
    }

    std::size_t Size() const { return _ends.size(); }

private:
    std::map<Stamp, Stamp> _ends;  // by the first of each range
};

}  // namespace Rabit::Backfill
