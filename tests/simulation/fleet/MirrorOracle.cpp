#include "MirrorOracle.h"

#include <rabit/simulated/SimulatedNetwork.h>

#include <string>

namespace Rabit::Sim
{

std::uint64_t MirrorOracle::OnPosted(Topic topic, std::size_t life)
{
    std::deque<Time> &posts = _posts[{topic, life}];
    posts.push_back(_world.Now);
    return posts.size();
}

void MirrorOracle::OnFetched(Topic topic, std::size_t observerLife, std::size_t node, std::uint64_t life,
                             std::uint64_t number, double ageSeconds)
{
    ++_fetched[static_cast<std::size_t>(topic)];
    const std::string name = std::string(topic == Topic::Track ? "track " : "mode ") +
                             std::to_string(number) + " of life " + std::to_string(life) + " of " +
                             _world.NameOf(node) + ", seen by " +
                             _world.NameOf(_world.Lives[observerLife].Node);
    const auto posts = _posts.find({topic, life});
    if (posts == _posts.end() || number == 0 || number > posts->second.size() ||
        _world.Lives[life].Node != node)
    {
        _world.Fail(8, name + ": never posted");
        return;
    }
    Seen &seen = _seen[{topic, {observerLife, node}}];
    if (seen.Anything && (life < seen.Life || (life == seen.Life && number < seen.Number)))
    {
        _world.Fail(
            12, name + ": after " + std::to_string(seen.Number) + " of life " + std::to_string(seen.Life));
    }
    seen = {life, number, true};

    const Time age = _world.Now - posts->second[number - 1];
    const auto shown = static_cast<std::int64_t>(ageSeconds * 1e9);
    if (shown < (age - Tolerance()).count() || shown > (age + Tolerance()).count())
    {
        _world.Fail(13, name + ": is " + std::to_string(static_cast<double>(age.count()) / 1e9) +
                            " s old and shown as " + std::to_string(ageSeconds) + " s old");
    }
}

Time MirrorOracle::Tolerance() const
{
    const std::optional<ThinPlan> &thin = _world.Plan.Thin;
    if (!thin)
    {
        return AgeTolerance;
    }
    const bool isSlowest = thin->BytesPerSecond < 10'000;
    const Time settled = isSlowest ? AgeTolerance : ThinAgeTolerance;
    if (_world.Now > _world.DisturbedAt + Settles)
    {
        return settled;
    }
    const std::uint64_t queues = SimulatedMedium().QueueBytes * _world.Plan.Machines.size();
    return settled + Time(std::chrono::seconds(1)) * queues / thin->BytesPerSecond / 4;
}

bool MirrorOracle::IsUpToDate(Topic topic, std::size_t observerLife, std::size_t life) const
{
    const auto posts = _posts.find({topic, life});
    if (posts == _posts.end())
    {
        return true;
    }
    const auto seen = _seen.find({topic, {observerLife, _world.Lives[life].Node}});
    return seen != _seen.end() && seen->second.Life == life && seen->second.Number == posts->second.size();
}

Time MirrorOracle::AgeOf(Topic topic, std::size_t observerLife, std::size_t life) const
{
    const auto seen = _seen.find({topic, {observerLife, _world.Lives[life].Node}});
    if (seen == _seen.end() || seen->second.Life != life)
    {
        return Time::max();
    }
    return _world.Now - _posts.at({topic, life})[seen->second.Number - 1];
}

}  // namespace Rabit::Sim
