#include "PresenceOracle.h"

#include <algorithm>
#include <string>
#include <utility>

namespace Rabit::Sim
{

namespace
{

using namespace std::chrono_literals;

// The gateway's promise: after StaleAfter missing beats a node is no longer UP, and after LostAfter it is
// LOST.
constexpr int StaleAfter = 3;
constexpr int LostAfter = 7;

// Largest size of a beat with a small budget, in bytes.
constexpr double LargestBeat = 400;

// Longest pause between two beats. It is a second where datagrams come late, which may be the weather's
// fault. With a budget it is the pause that a twentieth of the budget allows, if that is longer.
Time LongestPause(const FleetPlan &plan)
{
    if (!plan.Thin || !plan.Thin->Budget)
    {
        return 1s;
    }
    const std::chrono::duration<double> pause(LargestBeat * 20 / static_cast<double>(*plan.Thin->Budget));
    return std::clamp<Time>(std::chrono::duration_cast<Time>(pause), 1s, GatewayConfig().Radio.SlowestBeat);
}

}  // namespace

PresenceOracle::PresenceOracle(FleetWorld &world)
    : _world(world),
      _paths(world.Plan.Machines.size() * world.Plan.Machines.size()),
      _machines(world.Plan.Machines.size())
{
}

void PresenceOracle::OnCut(std::size_t from, std::size_t to)
{
    Path &path = _paths[from * _machines.size() + to];
    if (path.Cuts++ == 0)
    {
        path.CutAt = _world.Now;
    }
}

void PresenceOracle::OnCutEnd(std::size_t from, std::size_t to)
{
    --_paths[from * _machines.size() + to].Cuts;
}

void PresenceOracle::OnStarted(std::size_t node)
{
    _machines[node].Alive = true;
}

void PresenceOracle::OnEnded(std::size_t node)
{
    _machines[node] = {.Alive = false, .EndedAt = _world.Now};
}

void PresenceOracle::OnFleet(std::size_t observerLife, const Gateway::Fleet &fleet)
{
    const std::size_t observer = _world.Lives[observerLife].Node;
    const Time pause = LongestPause(_world.Plan);
    for (const Gateway::NodeStatus &status : fleet.nodes)
    {
        _stale += status.state == Gateway::NodeState::STALE ? 1 : 0;
        _lost += status.state == Gateway::NodeState::LOST ? 1 : 0;
        for (std::size_t node = 0; node < _machines.size(); ++node)
        {
            if (status.node != _world.NameOf(node))
            {
                continue;
            }
            SayWhatIsShown(observer, node, status.state);
            const Path &path = _paths[node * _machines.size() + observer];
            Time silence = _machines[node].Alive ? Time(0) : _world.Now - _machines[node].EndedAt;
            silence = path.Cuts > 0 ? std::max(silence, _world.Now - path.CutAt) : silence;
            const auto isTooLong = [&](Time time)
            {
                return (status.state == Gateway::NodeState::UP && time > StaleAfter * pause + Tolerance) ||
                       (status.state == Gateway::NodeState::STALE && time > LostAfter * pause + Tolerance);
            };
            const Time shown =
                _world.Now -
                _firstShown.try_emplace({observerLife, node, status.incarnation}, _world.Now).first->second;
            if (isTooLong(silence) && isTooLong(shown))
            {
                _world.Fail(14, _world.NameOf(observer) + " shows " + status.node + " as " +
                                    (status.state == Gateway::NodeState::UP ? "UP" : "STALE") + " after " +
                                    std::to_string(static_cast<double>(silence.count()) / 1e9) +
                                    " s of silence");
            }
        }
    }
}

void PresenceOracle::SayWhatIsShown(std::size_t observer, std::size_t node, Gateway::NodeState state)
{
    const auto [shown, isNew] = _shown.try_emplace({observer, node}, state);
    if (isNew || std::exchange(shown->second, state) != state)
    {
        const char *const name = state == Gateway::NodeState::UP      ? "UP"
                                 : state == Gateway::NodeState::STALE ? "STALE"
                                                                      : "LOST";
        _world.Say(_world.NameOf(observer) + " shows " + _world.NameOf(node) + " as " + name);
    }
}

bool PresenceOracle::IsUp(const Gateway::Fleet &fleet, const std::string &node)
{
    for (const Gateway::NodeStatus &status : fleet.nodes)
    {
        if (status.node == node)
        {
            return status.state == Gateway::NodeState::UP;
        }
    }
    return false;
}

}  // namespace Rabit::Sim
