#include "recording/merge/MergePlan.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace Rabit::Merge
{
namespace
{

class Planner
{
public:
    Planner(const Lives &lives, const MergeWishes &wishes) : _lives(lives), _wishes(wishes) {}

    MergePlan Run()
    {
        _plan.Lives.resize(_lives.All.size());
        if (ChooseTimeLine())
        {
            Relate();
            TakeOthers();
            Number();
        }
        return std::move(_plan);
    }

private:
    bool ChooseTimeLine()
    {
        std::vector<ClockGraph::Clock> clocks;
        for (const Life &life : _lives.All)
        {
            if (life.Clock)
            {
                clocks.push_back(*life.Clock);
            }
        }
        const auto worth = [&](const Life &life)
        {
            return std::tuple(life.Clock ? _lives.Graph.Relations(*life.Clock, clocks) : 0,
                              life.Clock ? _lives.Graph.Count(*life.Clock) : 0, life.End - life.Begin);
        };
        std::optional<std::size_t> best;
        for (std::size_t at = 0; at < _lives.All.size(); ++at)
        {
            const Life &life = _lives.All[at];
            if ((_wishes.Reference.empty() || life.Node == _wishes.Reference) &&
                (!best || worth(_lives.All[*best]) < worth(life)))
            {
                best = at;
            }
        }
        if (!best)
        {
            _plan.Problem = "there is no recording of " + _wishes.Reference;
            return false;
        }
        _plan.TimeLine = *best;
        _plan.Lives[*best].By = PlannedLife::Way::TimeLine;
        _plan.Lives[*best].Map = TimeMap::Constant(0, 0);
        return true;
    }

    void Relate()
    {
        const Life &timeLine = _lives.All[_plan.TimeLine];
        for (std::size_t at = 0; at < _lives.All.size(); ++at)
        {
            const Life &life = _lives.All[at];
            if (at == _plan.TimeLine)
            {
                continue;
            }
            auto map = life.Clock && timeLine.Clock
                           ? TimeMap::Along(_lives.Graph, {*life.Clock, life.SourceToLog},
                                            {*timeLine.Clock, timeLine.SourceToLog}, life.Begin, life.End)
                           : std::nullopt;
            if (map)
            {
                _plan.Lives[at].Map = std::move(*map);
            }
            else
            {
                _plan.Lives[at].By = PlannedLife::Way::WallClock;
            }
        }
    }

    // Puts lives without relations on the time line. A recording begins by its node's wall clock. Another
    // life of that node on the same host shows the offset of that clock, unless it was set meanwhile.
    void TakeOthers()
    {
        const Life &timeLine = _lives.All[_plan.TimeLine];
        for (std::size_t at = 0; at < _lives.All.size(); ++at)
        {
            const Life &life = _lives.All[at];
            PlannedLife &planned = _plan.Lives[at];
            if (planned.By != PlannedLife::Way::WallClock)
            {
                continue;
            }
            if (!_wishes.TakesWallClocks)
            {
                _plan.Problem = life.Files.front().Path + ": nothing relates the clock of " + life.Node +
                                " to that of " + timeLine.Node;
                return;
            }
            std::optional<Moment> nearest;
            for (std::size_t other = 0; other < _lives.All.size(); ++other)
            {
                const Life &known = _lives.All[other];
                if (_plan.Lives[other].By == PlannedLife::Way::WallClock || known.Node != life.Node ||
                    known.Host != life.Host)
                {
                    continue;
                }
                const Moment distance = std::min(Apart(known.End, life.Begin), Apart(known.Begin, life.End));
                if (!nearest || distance < *nearest)
                {
                    nearest = distance;
                    const Moment moment = std::clamp(life.Begin, known.Begin, known.End);
                    planned.Map = TimeMap::Constant(_plan.Lives[other].Map.At(moment) - moment, std::nullopt);
                }
            }
        }
    }

    void Number()
    {
        std::vector<std::size_t> order(_lives.All.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [this](std::size_t one, std::size_t other)
                         { return BeginOf(one) < BeginOf(other); });
        std::map<std::string, unsigned> numbers;
        for (const std::size_t at : order)
        {
            _plan.Lives[at].Number = ++numbers[_lives.All[at].Node];
        }
    }

    Moment BeginOf(std::size_t at) const { return _plan.Lives[at].Map.At(_lives.All[at].Begin); }

    const Lives &_lives;
    const MergeWishes &_wishes;
    MergePlan _plan;
};

}  // namespace

std::optional<Moment> MergePlan::WorstBound() const
{
    Moment worst = 0;
    for (const PlannedLife &life : Lives)
    {
        const auto bound = life.Map.WorstBound();
        if (!bound)
        {
            return std::nullopt;
        }
        worst = std::max(worst, *bound);
    }
    return worst;
}

MergePlan MakePlan(const Lives &lives, const MergeWishes &wishes)
{
    return Planner(lives, wishes).Run();
}

std::string NameOf(const Lives &lives, const MergePlan &plan, std::size_t life)
{
    const std::string &node = lives.All[life].Node;
    const auto count = std::count_if(lives.All.begin(), lives.All.end(),
                                     [&node](const Life &one) { return one.Node == node; });
    return count == 1 ? node : node + " (life " + std::to_string(plan.Lives[life].Number) + ")";
}

}  // namespace Rabit::Merge
