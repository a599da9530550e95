#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recording/merge/ClockGraph.h"

namespace Rabit::Merge
{

// Maps the log times of one recording to the time line, and never a later time to an earlier one.
class TimeMap
{
public:
    // For a recording that is the time line, or is put on it by a constant. `bound`: error of the constant;
    // empty: not known.
    static TimeMap Constant(Moment later, std::optional<Moment> bound);

    struct Side
    {
        ClockGraph::Clock Clock = 0;
        Moment SourceToLog = 0;
    };
    // For a recording from its first to its last log time; empty if no path joins its clock with that of
    // the time line.
    static std::optional<TimeMap> Along(const ClockGraph &graph, const Side &recording, const Side &timeLine,
                                        Moment begin, Moment end);

    Moment At(Moment logTime) const;
    // How wrong that may be; empty: not known.
    std::optional<Moment> BoundAt(Moment logTime) const;
    std::optional<Moment> WorstBound() const;
    // The bound that is not exceeded half of the time.
    std::optional<Moment> MedianBound() const;
    // The clocks between the two, at any time; none if the two nodes heard each other.
    const std::vector<ClockGraph::Clock> &By() const { return _by; }

private:
    struct Knot
    {
        Moment From = 0;
        Moment To = 0;
        Moment Bound = 0;
    };
    // The two knots around a time, and how far it is between them, from 0 to 1; at the ends the same knot
    // twice.
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
