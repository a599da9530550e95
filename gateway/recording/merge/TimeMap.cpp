#include "recording/merge/TimeMap.h"

#include <algorithm>
#include <set>

namespace Rabit::Merge
{
namespace
{

constexpr Moment LeastKnotDistance = OneSecond;
constexpr Moment MostKnots = 40000;

}  // namespace

TimeMap TimeMap::Constant(Moment later, std::optional<Moment> bound)
{
    TimeMap map;
    map._knots.push_back({0, later, bound.value_or(0)});
    map._hasBound = bound.has_value();
    return map;
}

std::optional<TimeMap> TimeMap::Along(const ClockGraph &graph, const Side &recording, const Side &timeLine,
                                      Moment begin, Moment end)
{
    TimeMap map;
    std::set<ClockGraph::Clock> by;
    const Moment distance = std::max(LeastKnotDistance, (end - begin) / MostKnots);
    for (Moment at = begin;; at = std::min(at + distance, end))
    {
        const auto reading = graph.Read(timeLine.Clock, recording.Clock, Within(at - recording.SourceToLog));
        if (!reading)
        {
            return std::nullopt;
        }
        Knot knot{at, Within(reading->Time + timeLine.SourceToLog), reading->Bound};
        if (!map._knots.empty() && knot.To < map._knots.back().To)
        {
            knot.Bound += map._knots.back().To - knot.To;
            knot.To = map._knots.back().To;
        }
        map._knots.push_back(knot);
        by.insert(reading->By.begin(), reading->By.end());
        if (at >= end)
        {
            break;
        }
    }
    map._by.assign(by.begin(), by.end());
    return map;
}

TimeMap::Place TimeMap::Find(Moment logTime) const
{
    const auto after = std::upper_bound(_knots.begin(), _knots.end(), logTime,
                                        [](Moment one, const Knot &knot) { return one < knot.From; });
    if (after == _knots.begin())
    {
        return {&*after, &*after, 0.0};
    }
    const Knot &left = *std::prev(after);
    if (after == _knots.end())
    {
        return {&left, &left, 0.0};
    }
    return {&left, &*after,
            static_cast<double>(logTime - left.From) / static_cast<double>(after->From - left.From)};
}

Moment TimeMap::At(Moment logTime) const
{
    const Place place = Find(logTime);
    if (place.Left == place.Right)
    {
        return Within(logTime - place.Left->From + place.Left->To);
    }
    return place.Left->To + PartOf(place.Right->To - place.Left->To, place.Part);
}

// The change of the offset between two knots may have come at once, so it is part of the bound.
Moment TimeMap::BoundOf(const Knot &left, const Knot &right)
{
    return Within(std::max(left.Bound, right.Bound) + Apart(right.To - left.To, right.From - left.From));
}

std::optional<Moment> TimeMap::BoundAt(Moment logTime) const
{
    const Place place = Find(logTime);
    return _hasBound ? std::optional(BoundOf(*place.Left, *place.Right)) : std::nullopt;
}

std::optional<Moment> TimeMap::WorstBound() const
{
    Moment worst = _knots.front().Bound;
    for (std::size_t i = 1; i < _knots.size(); ++i)
    {
        worst = std::max(worst, BoundOf(_knots[i - 1], _knots[i]));
    }
    return _hasBound ? std::optional(worst) : std::nullopt;
}

std::optional<Moment> TimeMap::MedianBound() const
{
    std::vector<Moment> bounds;
    bounds.reserve(_knots.size());
    for (std::size_t i = 0; i < _knots.size(); ++i)
    {
        bounds.push_back(BoundOf(_knots[i == 0 ? 0 : i - 1], _knots[i]));
    }
    const auto middle = bounds.begin() + static_cast<std::ptrdiff_t>((bounds.size() - 1) / 2);
    std::nth_element(bounds.begin(), middle, bounds.end());
    return _hasBound ? std::optional(*middle) : std::nullopt;
}

}  // namespace Rabit::Merge
