#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recording/merge/ClockPair.h"
#include "recording/merge/ClockReport.h"

namespace Rabit::Merge
{

// A graph of the source clocks of the lives of nodes. Its edges are the relations between clocks that all
// of them reported. A reading takes the path between two clocks with the least bound of the error, also
// through nodes without a recording. If a parallel path contradicts it, the difference is part of the
// bound. Not thread-safe; constant after Finish.
class ClockGraph
{
public:
    using Clock = std::size_t;

    // Returns the source clock of that life.
    Clock Of(const std::string &node, std::uint64_t incarnation);
    // Adds what the life with the clock `teller` reported at that log time of its recording. To be called
    // in the order of log times.
    void Add(Clock teller, Moment logTime, const ClockReport &report);
    // To be called once, after the last Add and before the first query.
    void Finish();

    struct Reading
    {
        Moment Time = 0;
        Moment Bound = 0;
        std::vector<Clock> By;  // between the two, in order
    };
    // Returns what `clock` showed when `other` showed `shows`; empty if no path joins them.
    std::optional<Reading> Read(Clock clock, Clock other, Moment shows) const;
    // Returns to how many of `others` the clock has relations.
    std::size_t Relations(Clock clock, const std::vector<Clock> &others) const;
    // Returns how many reports about relations of the clock are of use, over all time.
    std::size_t Count(Clock clock) const;
    const std::string &NodeOf(Clock clock) const { return _clocks[clock].Node; }
    std::size_t Size() const { return _clocks.size(); }

private:
    struct Edge
    {
        Clock To = 0;
        std::shared_ptr<ClockPair> Pair;
        bool IsForward = true;  // this clock is the pair's first one
    };
    struct Known
    {
        std::string Node;
        std::vector<Edge> Edges;
    };

    ClockPair &PairOf(Clock teller, Clock peer);
    static ClockPair::Reading ReadEdge(const Edge &edge, Moment time);

    std::map<std::pair<std::string, std::uint64_t>, Clock> _byLife;
    std::map<std::pair<Clock, Clock>, std::shared_ptr<ClockPair>> _pairs;  // by reporting clock and peer
    std::vector<Known> _clocks;
};

}  // namespace Rabit::Merge
