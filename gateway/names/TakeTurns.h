#pragma once

#include <cstddef>

namespace Rabit
{

// Offers the entries of a map in turn, each at most once, beginning after `last`, until `most` were taken.
// `take(key, value)` returns true if it takes the entry; `last` becomes the key of that entry.
template <typename Map, typename Take>
void TakeTurns(Map &map, typename Map::key_type &last, std::size_t most, const Take &take)
{
    std::size_t taken = 0;
    auto next = map.upper_bound(last);
    for (std::size_t looked = 0; looked < map.size() && taken < most; ++looked, ++next)
    {
        if (next == map.end())
        {
            next = map.begin();
        }
        if (take(next->first, next->second))
        {
            last = next->first;
            ++taken;
        }
    }
}

}  // namespace Rabit
