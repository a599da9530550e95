#pragma once

#include <rabit/base/Earliest.h>

#include <algorithm>
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

// For a map of entries with a BackoffTimer `Ask`: when the next question is due, and the number of questions
// that are due, at most `most`.
template <typename Map>
auto NextAsk(const Map &map)
{
    decltype(map.begin()->second.Ask.Due()) next;
    for (const auto &[key, entry] : map)
    {
        next = Earliest({next, entry.Ask.Due()});
    }
    return next;
}

template <typename Map, typename Time>
std::size_t CountAsks(const Map &map, Time now, std::size_t most)
{
    const auto due = std::count_if(map.begin(), map.end(),
                                   [now](const auto &entry) { return entry.second.Ask.IsDue(now); });
    return std::min(static_cast<std::size_t>(due), most);
}

}  // namespace Rabit
