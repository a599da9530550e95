#include "paths/PathChoice.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace Rabit
{

using Gateway::NodeState;

PathChoice::PathChoice(std::size_t paths, std::vector<double> budgets)
    : _paths(paths), _budgets(std::move(budgets))
{
    _budgets.resize(paths, std::numeric_limits<double>::infinity());
}

PathChoice::Node &PathChoice::NodeOf(const std::string &node)
{
    Node &found = _nodes[node];
    found.Ways.resize(_paths);
    return found;
}

void PathChoice::Fail(Node &node, std::size_t path, Duration now) const
{
    Way &way = node.Ways[path];
    if (way.IsSound(now))
    {
        way.Rest.Reset();
    }
    way.RestFor = way.Rest.Next();
    bool isBest = true;  // of those on which the node is UP, by their budgets
    for (std::size_t other = 0; other < _paths; ++other)
    {
        isBest = isBest && (other == path || node.Ways[other].State != NodeState::UP ||
                            _budgets[other] < _budgets[path]);
    }
    if (isBest)
    {
        way.RestFor = std::min(way.RestFor, ShortRest);
    }
    way.RestsUntil = now + way.RestFor;
}

void PathChoice::Heard(const std::string &node, std::size_t path, NodeState state, bool hearsHereFirst,
                       Duration now)
{
    if (_paths == 1)
    {
        return;
    }
    Node &of = NodeOf(node);
    Way &way = of.Ways.at(path);
    const bool heard = std::exchange(way.HearsHereFirst, hearsHereFirst);
    const NodeState before = std::exchange(way.State, state);
    if (before == state && heard == hearsHereFirst)
    {
        return;
    }
    if (before == NodeState::UP && state != NodeState::UP)
    {
        Fail(of, path, now);
    }
    else if (before != NodeState::UP && state == NodeState::UP && way.RestsUntil)
    {
        // The rest begins when the path is there again.
        way.RestsUntil = now + way.RestFor;
    }
    if (heard && !hearsHereFirst)
    {
        // The node hears this one by an earlier path again, which has to prove itself.
        for (std::size_t earlier = 0; earlier < path; ++earlier)
        {
            Way &proving = of.Ways[earlier];
            if (proving.IsSound(now))
            {
                proving.Rest.Reset();
            }
            proving.RestsUntil = std::max(proving.RestsUntil.value_or(now), now);
        }
    }
    Choose(node, of, now);
}

void PathChoice::Missed(const std::string &node, std::size_t path, const BeatCount &beats, Duration now)
{
    if (_paths == 1)
    {
        return;
    }
    Node &of = NodeOf(node);
    Way &way = of.Ways.at(path);
    BeatCount before = std::exchange(way.Beats, beats);
    if (beats.Heard() < before.Heard() || beats.Missed() < before.Missed())
    {
        before = BeatCount();  // of an earlier incarnation
    }
    if (way.State != NodeState::UP)
    {
        way.Missed = 0.0;  // it has failed for these
        return;
    }
    const auto came = static_cast<double>(beats.Heard() - before.Heard());
    way.Missed = std::max(way.Missed - MissedForgiven * came, 0.0) +
                 static_cast<double>(beats.Missed() - before.Missed());
    const bool isOver = way.Missed >= MostMissed;
    way.Missed = std::min(way.Missed, MostMissed);
    if (isOver && beats.Missed() > before.Missed() && !way.Rests(now) && IsAnyBetter(of, path, now))
    {
        Fail(of, path, now);
        Choose(node, of, now);
    }
}

bool PathChoice::IsAnyBetter(const Node &node, std::size_t path, Duration now) const
{
    for (std::size_t other = 0; other < _paths; ++other)
    {
        const Way &way = node.Ways[other];
        if (other != path && way.State == NodeState::UP && !way.Rests(now) && way.Missed <= MostMissed / 2 &&
            _budgets[other] >= _budgets[path])
        {
            return true;
        }
    }
    return false;
}

bool PathChoice::Unanswered(const std::string &node, Duration now)
{
    const auto found = _nodes.find(node);
    if (_paths == 1 || found == _nodes.end())
    {
        return false;
    }
    Node &of = found->second;
    const std::optional<std::size_t> other = Other(of, now);
    if (!other)
    {
        return false;
    }
    const bool isNew = of.Second != other || now >= of.SecondUntil;
    of.Second = other;
    of.SecondUntil = now + Both;
    return isNew;
}

std::optional<std::size_t> PathChoice::Other(const Node &node, Duration now) const
{
    std::optional<std::size_t> other;
    for (std::size_t path = 0; path < _paths; ++path)
    {
        if (path != node.Choice && node.Ways[path].State == NodeState::UP &&
            (!other || (!node.Ways[*other].IsSteady(now) && node.Ways[path].IsSteady(now))))
        {
            other = path;
        }
    }
    return other;
}

void PathChoice::Late(const std::string &node, std::size_t path, bool isLate)
{
    const auto found = _nodes.find(node);
    if (_paths > 1 && found != _nodes.end())
    {
        found->second.Ways[path].IsLate = isLate;
    }
}

void PathChoice::CameBy(const std::string &node, std::size_t path, Duration now)
{
    const auto found = _nodes.find(node);
    if (_paths == 1 || found == _nodes.end())
    {
        return;
    }
    Node &of = found->second;
    of.Ways[path].CameAt = now;
    if (path != of.Choice && now - of.Ways[of.Choice].CameAt >= Silence)
    {
        of.Second = path;
        of.SecondUntil = now + Both;
    }
}

void PathChoice::MessageCameBy(const std::string &node, std::size_t path, Duration now)
{
    const auto found = _nodes.find(node);
    if (_paths > 1 && found != _nodes.end() && path != found->second.Choice)
    {
        found->second.AnswersBy = path;
        found->second.AnswersUntil = now + AnswersToo;
    }
}

void PathChoice::ChooseHeard(Node &node, Duration now)
{
    std::size_t first = _paths;
    bool firstRests = true;
    for (std::size_t path = 0; path < _paths; ++path)
    {
        const Way &way = node.Ways[path];
        if (way.State != NodeState::UP)
        {
            continue;
        }
        const bool rests = way.Rests(now);
        if (rests)
        {
            _due = _due ? std::min(*_due, *way.RestsUntil) : *way.RestsUntil;
        }
        if (first == _paths || (firstRests && !rests))
        {
            first = path;
            firstRests = rests;
        }
    }
    _firstHeardChanged |= std::exchange(node.FirstHeardOn, first) != first;
}

void PathChoice::Choose(const std::string &name, Node &node, Duration now)
{
    // By a path before this one the node does not hear this node.
    std::size_t first = 0;
    for (std::size_t path = 0; path < _paths; ++path)
    {
        first = node.Ways[path].State == NodeState::UP && node.Ways[path].HearsHereFirst ? path : first;
    }
    ChooseHeard(node, now);
    std::optional<std::size_t> rested;  // that is UP and rests
    std::optional<std::size_t> chosen;
    for (std::size_t path = first; path < _paths && !chosen; ++path)
    {
        const Way &way = node.Ways[path];
        if (way.State == NodeState::UP && !way.Rests(now))
        {
            chosen = path;
        }
        else if (way.State == NodeState::UP)
        {
            // With nothing but paths that rest, the present one stays.
            rested = path == node.Choice || !rested ? path : rested;
        }
    }
    const std::size_t next = chosen.value_or(rested.value_or(node.Choice));
    if (std::exchange(node.Choice, next) != next)
    {
        _changed.push_back(name);
        node.Second.reset();
    }
}

std::vector<std::string> PathChoice::TakeChanged(Duration now)
{
    if (_due && *_due <= now)
    {
        _due.reset();
        for (auto &[name, node] : _nodes)
        {
            Choose(name, node, now);
        }
    }
    return std::exchange(_changed, {});
}

std::size_t PathChoice::Of(std::string_view node) const
{
    const auto found = _paths == 1 ? _nodes.end() : _nodes.find(node);
    return found == _nodes.end() ? 0 : found->second.Choice;
}

std::optional<std::size_t> PathChoice::Second(std::string_view node, Duration now, bool isAnswer) const
{
    const auto found = _paths == 1 ? _nodes.end() : _nodes.find(node);
    if (found == _nodes.end())
    {
        return std::nullopt;
    }
    const Node &of = found->second;
    if (of.Second && now < of.SecondUntil && of.Ways[*of.Second].State == NodeState::UP)
    {
        return of.Second;
    }
    const Way &chosen = of.Ways[of.Choice];
    const std::optional<std::size_t> other = chosen.IsSteady(now) ? std::nullopt : Other(of, now);
    if (other && (chosen.IsLate || of.Ways[*other].IsSteady(now)))
    {
        return other;
    }
    return isAnswer && of.AnswersBy != of.Choice && now < of.AnswersUntil ? of.AnswersBy : std::nullopt;
}

std::vector<std::string> PathChoice::FirstHeardOn(std::size_t path) const
{
    std::vector<std::string> nodes;
    for (const auto &[name, node] : _nodes)
    {
        if (path > 0 && node.FirstHeardOn == path)
        {
            nodes.push_back(name);
        }
    }
    return nodes;
}

bool PathChoice::CarriesAny(std::size_t path) const
{
    bool any = false;
    for (const auto &[name, node] : _nodes)
    {
        if (node.Ways[node.Choice].State != NodeState::LOST)
        {
            any = true;
            if (node.Choice == path)
            {
                return true;
            }
        }
    }
    return !any && path == 0;
}

bool PathChoice::IsSecondOfAny(std::size_t path, Duration now) const
{
    return std::any_of(_nodes.begin(), _nodes.end(),
                       [this, path, now](const auto &node) { return Second(node.first, now, true) == path; });
}

}  // namespace Rabit
