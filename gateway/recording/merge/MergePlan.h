#pragma once

#include <string>
#include <vector>

#include "recording/merge/Lives.h"
#include "recording/merge/TimeMap.h"

namespace Rabit::Merge
{

// How one life comes on the time line.
struct PlannedLife
{
    enum class Way
    {
        TimeLine,   // its clock is the time line
        Relations,  // by what was told of clocks
        WallClock   // nothing relates its clock: as it is, or as that of another life of that node stands
    };
    unsigned Number = 1;  // of the lives of that node, from 1, by their beginning on the time line
    Way By = Way::Relations;
    TimeMap Map = TimeMap::Constant(0, std::nullopt);
};

// What to do with lives.
struct MergePlan
{
    std::vector<PlannedLife> Lives;  // as in Lives::All
    std::size_t TimeLine = 0;        // which of them is
    std::string Problem;             // why they cannot be merged; empty: nothing

    // How wrong the time of a message may be at most; empty: not known.
    std::optional<Moment> WorstBound() const;
};

struct MergeWishes
{
    // Of the lives of this node one is the time line. Empty: that life which has relations with most others;
    // of several that which has most of them over time.
    std::string Reference;
    // Lives whose clocks nothing relates to that are taken by their wall clocks, and not refused.
    bool TakesWallClocks = false;
};

MergePlan MakePlan(const Lives &lives, const MergeWishes &wishes);

// For people: `uav1`, or `uav1 (life 2)` if there are several.
std::string NameOf(const Lives &lives, const MergePlan &plan, std::size_t life);

}  // namespace Rabit::Merge
