#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recording/merge/ClockGraph.h"

namespace Rabit::Merge
{

// From the log times of one recording to those of the time line. Never maps a later time to an earlier one.
class TimeMap
{
public:
    // The recording is the time line, or is put on it by a constant that may be wrong by anything.
    static TimeMap Constant(Moment later, std::optional<Moment> bound);

    struct Side
    {
        ClockGraph::Clock Clock = 0;
        Moment SourceToLog = 0;
    };
    // For a recording from its first to its last log time; empty if nothing leads from its clock to that of
    // the time line.
    static std::optional<TimeMap> Along(const ClockGraph &graph, const Side &recording, const Side &timeLine,
                                        Moment begin, Moment end);

    Moment At(Moment logTime) const;
    // How wrong that may be; empty: not known.
    std::optional<Moment> BoundAt(Moment logTime) const;
    std::optional<Moment> WorstBound() const;
    // Half of the time it is no larger.
    std::optional<Moment> MedianBound() const;
    // The clocks that led there, at any time; none if the two heard each other.
    const std::vector<ClockGraph::Clock> &By() const { return _by; }

private:
    struct Knot
    {
        Moment From = 0;
        Moment To = 0;
        Moment Bound = 0;
    };
    // The two around that time and how far it is between them, from 0 to 1; the same one twice at the ends.
    struct Place
    {
        const Knot *Left;
        const Knot *Right;
        double Part;
    };
    Place Find(Moment logTime) const;
    static Moment BoundOf(const Knot &left, const Knot &right);

    std::vector<Knot> _knots;  // one at least
    bool _hasBound = true;
    std::vector<ClockGraph::Clock> _by;
};

}  // namespace Rabit::Merge
