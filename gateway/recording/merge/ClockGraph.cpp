#include "recording/merge/ClockGraph.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <set>

namespace Rabit::Merge
{

ClockGraph::Clock ClockGraph::Of(const std::string &node, std::uint64_t incarnation)
{
    const auto [known, isNew] = _byLife.try_emplace({node, incarnation}, _clocks.size());
    if (isNew)
    {
        _clocks.push_back({node, {}});
    }
    return known->second;
}

ClockPair &ClockGraph::PairOf(Clock teller, Clock peer)
{
    std::shared_ptr<ClockPair> &pair = _pairs[{teller, peer}];
    if (!pair)
    {
        pair = std::make_shared<ClockPair>();
    }
    return *pair;
}

void ClockGraph::Add(Clock teller, Moment logTime, const ClockReport &report)
{
    for (const ClockReport::Peer &peer : report.Peers)
    {
        const Clock other = Of(peer.Node, peer.Incarnation);
        if (other != teller)
        {
            PairOf(teller, other)
                .Add(Within(logTime - report.SourceToLog), Within(logTime - peer.SourceToLog),
                     peer.UncertainBy);
        }
    }
}

void ClockGraph::Finish()
{
    for (const auto &[clocks, pair] : _pairs)
    {
        pair->Finish();
        if (pair->Count() > 0)
        {
            _clocks[clocks.first].Edges.push_back({clocks.second, pair, true});
            _clocks[clocks.second].Edges.push_back({clocks.first, pair, false});
        }
    }
}

// An edge always has a reading: Finish makes none for pairs without one.
ClockPair::Reading ClockGraph::ReadEdge(const Edge &edge, Moment time)
{
    const auto reading = edge.IsForward ? edge.Pair->ToSecond(time) : edge.Pair->ToFirst(time);
    return reading.value_or(ClockPair::Reading());
}

// Finds the path with the least sum of bounds (Dijkstra), and carries the time along.
std::optional<ClockGraph::Reading> ClockGraph::Read(Clock clock, Clock other, Moment shows) const
{
    struct Reached
    {
        Moment Time = 0;
        Moment Bound = 0;
        Clock From = 0;
        bool Known = false;
        bool Done = false;
    };
    std::vector<Reached> reached(_clocks.size());
    using Next = std::pair<Moment, Clock>;
    std::priority_queue<Next, std::vector<Next>, std::greater<>> next;
    reached[other] = {shows, 0, other, true, false};
    next.emplace(0, other);
    while (!next.empty())
    {
        const Clock at = next.top().second;
        next.pop();
        if (std::exchange(reached[at].Done, true))
        {
            continue;
        }
        for (const Edge &edge : _clocks[at].Edges)
        {
            if (reached[edge.To].Done)
            {
                continue;
            }
            const auto reading = ReadEdge(edge, reached[at].Time);
            const Moment bound = Within(reached[at].Bound + reading.Bound);
            if (!reached[edge.To].Known || bound < reached[edge.To].Bound)
            {
                reached[edge.To] = {reading.Time, bound, at, true, false};
                next.emplace(bound, edge.To);
            }
        }
    }
    if (!reached[clock].Known)
    {
        return std::nullopt;
    }
    Reading reading{reached[clock].Time, reached[clock].Bound, {}};
    for (Clock at = clock; at != other && reached[at].From != other; at = reached[at].From)
    {
        reading.By.push_back(reached[at].From);
    }
    std::reverse(reading.By.begin(), reading.By.end());
    // If two paths disagree by more than their bounds, a clock stood still, and one path does not show it.
    Moment disagreement = 0;
    for (Clock at = clock;; at = reached[at].From)
    {
        for (const Edge &edge : _clocks[at].Edges)
        {
            const auto beside = ReadEdge(edge, reached[at].Time);
            const Moment differ = Apart(beside.Time, reached[edge.To].Time);
            const Moment explained = Within(reached[at].Bound + beside.Bound + reached[edge.To].Bound);
            if (differ > explained)
            {
                disagreement = std::max(disagreement, Within(differ + explained));
            }
        }
        if (at == other)
        {
            break;
        }
    }
    reading.Bound = Within(reading.Bound + disagreement);
    return reading;
}

std::size_t ClockGraph::Relations(Clock clock, const std::vector<Clock> &others) const
{
    std::set<Clock> related;
    for (const Edge &edge : _clocks[clock].Edges)
    {
        if (std::find(others.begin(), others.end(), edge.To) != others.end())
        {
            related.insert(edge.To);
        }
    }
    return related.size();
}

std::size_t ClockGraph::Count(Clock clock) const
{
    std::size_t count = 0;
    for (const Edge &edge : _clocks[clock].Edges)
    {
        count += edge.Pair->Count();
    }
    return count;
}

}  // namespace Rabit::Merge
