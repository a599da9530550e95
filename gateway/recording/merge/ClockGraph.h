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

// The source clocks of the lives of nodes, and how they stand to each other: what all of them told. From one
// clock to another it goes by whichever clocks between them make the bound of the error least, also by those
// of nodes of which there is no recording. Where other ways beside it contradict it, that is part of the
// bound. Not thread-safe; constant after Finish.
class ClockGraph
{
public:
    using Clock = std::size_t;

    // The source clock of that life.
    Clock Of(const std::string &node, std::uint64_t incarnation);
    // What that life of a node told at that log time of its recording. In the order of log times.
    void Add(Clock teller, Moment logTime, const ClockReport &report);
    // Before anything is asked; nothing is added after it.
    void Finish();

    struct Reading
    {
        Moment Time = 0;
        Moment Bound = 0;
        std::vector<Clock> By;  // between the two, in order
    };
    // What one clock showed when the other showed that; empty if nothing leads from one to the other.
    std::optional<Reading> Read(Clock clock, Clock other, Moment shows) const;
    // How many clocks that one has relations with, of those that are asked for.
    std::size_t Relations(Clock clock, const std::vector<Clock> &others) const;
    // How many relations of it are known, over all time.
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
    std::map<std::pair<Clock, Clock>, std::shared_ptr<ClockPair>> _pairs;  // who told, of whom
    std::vector<Known> _clocks;
};

}  // namespace Rabit::Merge
