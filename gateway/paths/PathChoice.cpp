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

void PathChoice::Heard(const std::string &node, std::size_t path, NodeState state, bool hearsHereFirst)
{
    if (_paths == 1)
    {
        return;
    }
    Node &of = _nodes[node];
    of.Ways.resize(_paths);
    Way &way = of.Ways.at(path);
    way.State = state;
    if (std::none_of(of.Ways.begin(), of.Ways.end(), [](const Way &each) { return each.IsUp(); }))
    {
        of.Incarnation = 0;  // the next life may have a lower one
    }
    if (std::exchange(way.HearsHereFirst, hearsHereFirst) && !hearsHereFirst)
    {
        // The node hears this one by an earlier path again, which has to prove itself.
        std::for_each(of.Ways.begin(), of.Ways.begin() + static_cast<std::ptrdiff_t>(path),
                      [](Way &earlier) { earlier.Missed = std::max(earlier.Missed, Return); });
    }
    _isNew = true;
}

void PathChoice::Look(const std::string &node, std::size_t path, const Beats &beats)
{
    const auto found = _nodes.find(node);
    if (_paths == 1 || found == _nodes.end())
    {
        return;
    }
    Node &of = found->second;
    if (beats.Incarnation > of.Incarnation)
    {
        of.Incarnation = beats.Incarnation;
        for (Way &each : of.Ways)
        {
            each.Count = {};
            each.Missed = each.Overdue = 0.0;
        }
    }
    Way &way = of.Ways.at(path);
    const double overdue = std::chrono::duration<double>(beats.Overdue) / beats.Period;
    way.Overdue = beats.Incarnation < of.Incarnation ? Most : std::clamp(overdue, 0.0, Most);
    const BeatCount before = std::exchange(way.Count, beats.Count);
    // Smaller numbers: the beats are counted anew.
    const bool goesOn = beats.Count.Heard() >= before.Heard() && beats.Count.Missed() >= before.Missed();
    const double came = static_cast<double>(beats.Count.Heard() - (goesOn ? before.Heard() : 0));
    const double missed = static_cast<double>(beats.Count.Missed() - (goesOn ? before.Missed() : 0));
    way.Missed = std::max(std::min(way.Missed + missed, Most) - Forgiven * came, 0.0);
    _isNew = true;
}

std::optional<std::size_t> PathChoice::Other(const Node &node, std::size_t than)
{
    std::optional<std::size_t> other;
    for (std::size_t path = 0; path < node.Ways.size(); ++path)
    {
        if (path != than && node.Ways[path].IsUp() &&
            (!other || node.Ways[path].Debt() < node.Ways[*other].Debt()))
        {
            other = path;
        }
    }
    return other;
}

std::optional<std::size_t> PathChoice::Best(const Node &node, std::size_t from, std::size_t present) const
{
    const auto mayBeUsed = [&](std::size_t path)
    {
        if (!node.Ways[path].IsUp())
        {
            return false;
        }
        for (std::size_t other = from; other < _paths; ++other)
        {
            const double more =
                (path == present ? Leave : Return) + (_budgets[other] < _budgets[path] ? Slow : 0.0);
            if (node.Ways[other].IsUp() && node.Ways[path].Debt() > node.Ways[other].Debt() + more)
            {
                return false;
            }
        }
        return true;
    };
    for (std::size_t path = from; path < _paths; ++path)
    {
        if (mayBeUsed(path))
        {
            return path;
        }
    }
    return std::nullopt;
}

bool PathChoice::Unanswered(const std::string &node, Duration now)
{
    const auto found = _nodes.find(node);
    if (found == _nodes.end() || !Other(found->second, found->second.Choice))
    {
        return false;
    }
    return std::exchange(found->second.DoubtUntil, now + Both) <= now;
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
        of.DoubtUntil = now + Both;
    }
}

void PathChoice::MessageCameBy(const std::string &node, std::size_t path, Duration now)
{
    const auto found = _nodes.find(node);
    if (found != _nodes.end() && path != found->second.Choice)
    {
        found->second.AnswersBy = path;
        found->second.AnswersUntil = now + AnswersToo;
    }
}

std::vector<std::string> PathChoice::TakeChanged()
{
    std::vector<std::string> changed;
    if (!std::exchange(_isNew, false))
    {
        return changed;
    }
    for (auto &[name, node] : _nodes)
    {
        const std::size_t heard = Best(node, 0, node.FirstHeardOn).value_or(_paths);
        _firstHeardChanged |= std::exchange(node.FirstHeardOn, heard) != heard;
        std::size_t from = 0;  // by an earlier path the node does not hear this one
        for (std::size_t path = 0; path < _paths; ++path)
        {
            from = node.Ways[path].IsUp() && node.Ways[path].HearsHereFirst ? path : from;
        }
        const std::size_t next = Best(node, from, node.Choice).value_or(node.Choice);
        if (std::exchange(node.Choice, next) != next)
        {
            node.DoubtUntil = {};
            changed.push_back(name);
        }
    }
    return changed;
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
    const std::optional<std::size_t> other = Other(of, of.Choice);
    if (other && (now < of.DoubtUntil || of.Ways[of.Choice].Debt() > of.Ways[*other].Debt() + Doubt))
    {
        return other;
    }
    return isAnswer && of.AnswersBy != of.Choice && now < of.AnswersUntil ? std::optional(of.AnswersBy)
                                                                          : std::nullopt;
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
