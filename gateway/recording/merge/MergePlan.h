#pragma once

#include <string>
#include <vector>

#include "recording/merge/Lives.h"
#include "recording/merge/TimeMap.h"

namespace Rabit::Merge
{

// How one life is put on the time line.
struct PlannedLife
{
    enum class Way
    {
        TimeLine,   // its clock is the time line
        Relations,  // by the relations in clock reports
        WallClock   // no relation: its wall clock, or the offset of another life of that node
    };
    unsigned Number = 1;  // of the lives of that node, from 1, by their beginning on the time line
    Way By = Way::Relations;
    TimeMap Map = TimeMap::Constant(0, std::nullopt);
};

// How all lives are put on the time line.
struct MergePlan
{
    std::vector<PlannedLife> Lives;  // as in Lives::All
    std::size_t TimeLine = 0;        // the index of the life that is it
    std::string Problem;             // why they cannot be merged; empty: they can

    // How wrong the time of a message may be at most; empty: not known.
    std::optional<Moment> WorstBound() const;
};

struct MergeWishes
{
    // The node of which one life is the time line. Empty: the life with relations to most others; of
    // several, the one with most relations over time.
    std::string Reference;
    // True: lives without a relation to the time line are put on it by their wall clocks. False: they are
    // refused.
    bool TakesWallClocks = false;
};

MergePlan MakePlan(const Lives &lives, const MergeWishes &wishes);

// For people: `uav1`, or `uav1 (life 2)` if there are several.
std::string NameOf(const Lives &lives, const MergePlan &plan, std::size_t life);

}  // namespace Rabit::Merge
