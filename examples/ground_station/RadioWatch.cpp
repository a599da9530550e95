#include "RadioWatch.h"

#include <algorithm>

namespace Ground
{
namespace
{
// Least time between two kept counters: a Fleet may come more often than needed.
constexpr RadioWatch::Duration Spacing = std::chrono::milliseconds(500);
// Smaller differences come from the times of counting: posts and samples are not counted at one moment.
constexpr double Clearly = 0.9;
}  // namespace

void RadioWatch::Look(const Rabit::Gateway::Fleet &fleet, Duration postedAt)
{
    if (_use.Known && postedAt == _history.back().At)
        return;
    // Another incarnation of the gateway counts from zero.
    if (_use.Known && (fleet.incarnation != _incarnation || postedAt < _history.back().At))
        _history.clear();
    _incarnation = fleet.incarnation;
    Keep(CountersOf(fleet, postedAt));

    _use = RadioUse();
    _use.Known = true;
    _use.Air = fleet.air;
    const Duration seen = postedAt - _history.front().At;
    if (seen < Shortest)
        return;
    const double seconds = std::chrono::duration<double>(seen).count();
    if (_use.IsLimited())
        LookAtStreams(seconds);
    LookAtLinks(fleet, seconds);
}

RadioWatch::Counters RadioWatch::CountersOf(const Rabit::Gateway::Fleet &fleet, Duration postedAt) const
{
    Counters counters;
    counters.At = postedAt;
    for (const auto &publication : fleet.publications)
        counters.Streams[publication.message] = {publication.offered, publication.replaced};
    for (const auto &link : fleet.links)
    {
        const LinkName name{link.node, link.queue};
        Duration emptyAt = postedAt;
        if (link.outbox > 0 && !_history.empty())
        {
            const auto before = _history.back().Links.find(name);
            emptyAt = before == _history.back().Links.end() ? _history.back().At : before->second.EmptyAt;
        }
        counters.Links[name] = {link.delivered, link.expired, emptyAt};
    }
    return counters;
}

void RadioWatch::Keep(Counters counters)
{
    const Duration now = counters.At;
    if (_history.size() > 1 && _history.back().At - _history[_history.size() - 2].At < Spacing)
        _history.back() = std::move(counters);
    else
        _history.push_back(std::move(counters));
    while (_history.size() > 2 && now - _history[1].At >= Window)
        _history.pop_front();
}

void RadioWatch::LookAtStreams(double seconds)
{
    std::vector<std::pair<double, HeldStream>> held;
    for (const auto &[message, now] : _history.back().Streams)
    {
        const auto before = _history.front().Streams.find(message);
        const Posts then = before == _history.front().Streams.end() ? Posts() : before->second;
        if (now.Offered < then.Offered || now.Replaced <= then.Replaced)
            continue;
        const double posted = static_cast<double>(now.Offered - then.Offered) / seconds;
        const double replaced = static_cast<double>(now.Replaced - then.Replaced) / seconds;
        const double sent = std::max(0.0, posted - replaced);
        const auto limit = _maxRates.find(message);
        const double wanted = limit == _maxRates.end() ? posted : std::min(posted, limit->second);
        if (sent < Clearly * wanted)
            held.push_back({wanted - sent, {message, posted, sent}});
    }
    std::stable_sort(held.begin(), held.end(),
                     [](const auto &a, const auto &b) { return a.first > b.first; });
    for (auto &[lacking, stream] : held)
    {
        _use.PostsHeldPerS += lacking;
        _use.Streams.push_back(std::move(stream));
    }
}

void RadioWatch::LookAtLinks(const Rabit::Gateway::Fleet &fleet, double seconds)
{
    for (const auto &link : fleet.links)
    {
        const LinkName name{link.node, link.queue};
        const auto before = _history.front().Links.find(name);
        const Messages then = before == _history.front().Links.end() ? Messages() : before->second;
        const Messages &now = _history.back().Links.at(name);
        const double delivered =
            static_cast<double>(now.Delivered - std::min(then.Delivered, now.Delivered)) / seconds;
        const bool waits = link.outbox > 0 && _history.back().At - now.EmptyAt >= Shortest &&
                           static_cast<double>(link.outbox) > delivered;
        if (!waits && now.Expired <= then.Expired)
            continue;
        _use.Links.push_back({link.node, link.queue, link.outbox, link.expired});
        _use.MessagesHeld += link.outbox;
    }
    std::stable_sort(_use.Links.begin(), _use.Links.end(),
                     [](const HeldLink &a, const HeldLink &b) { return a.Waiting > b.Waiting; });
}

}  // namespace Ground
