#include "Medium.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace Rabit::Radio
{
namespace
{

constexpr std::int64_t Nano = 1'000'000'000;

std::optional<std::int64_t> Checked(std::optional<std::int64_t> bitsPerSecond)
{
    if (bitsPerSecond && (*bitsPerSecond < 1 || *bitsPerSecond > Medium::MostBitsPerSecond))
    {
        throw std::invalid_argument("a rate is from 1 to 10^10 bit/s");
    }
    return bitsPerSecond;
}

}  // namespace

Medium::Medium(const MediumSettings &settings)
    : _rate(Checked(settings.BitsPerSecond)),
      _queueBytes(settings.QueueBytes),
      _overhead(settings.Overhead),
      _random(settings.Seed)
{
}

std::size_t Medium::Add(const std::string &name, const MacAddress &address)
{
    if (Find(name) || _byAddress.contains(address))
    {
        throw std::invalid_argument("two nodes of one name or address: " + name);
    }
    const std::size_t before = _nodes.size();
    std::vector<Link> links((before + 1) * (before + 1));
    for (std::size_t from = 0; from < before; ++from)
    {
        for (std::size_t to = 0; to < before; ++to)
        {
            links[from * (before + 1) + to] = _links[from * before + to];
        }
    }
    _links = std::move(links);
    _nodes.push_back({name, SendQueue(_queueBytes), {}});
    _byAddress[address] = before;
    return before;
}

std::optional<std::size_t> Medium::Find(const std::string &name) const
{
    for (std::size_t node = 0; node < _nodes.size(); ++node)
    {
        if (_nodes[node].Name == name)
        {
            return node;
        }
    }
    return std::nullopt;
}

void Medium::Offer(Time now, std::size_t node, FramePointer frame)
{
    now = Run(now);
    Node &sender = _nodes.at(node);
    const std::size_t bytes = frame->size();
    sender.Counters.Offered.Add(bytes);
    if (!sender.Queue.Push(now, std::move(frame)))
    {
        sender.Counters.Dropped.Add(bytes);
        return;
    }
    if (!_air)
    {
        BeginNext(now);
        Run(now);
    }
}

void Medium::Advance(Time now, std::vector<Arrival> &arrived)
{
    now = Run(now);
    while (!_coming.empty() && _coming.top().second.At <= now)
    {
        const Arrival &next = _coming.top().second;
        _nodes[next.To].Counters.Heard.Add(next.What->size());
        arrived.push_back(next);
        _coming.pop();
    }
}

std::optional<Time> Medium::NextEvent() const
{
    std::optional<Time> next;
    if (_air)
    {
        next = _air->Ends;
    }
    if (!_coming.empty())
    {
        next = std::min(next.value_or(_coming.top().second.At), _coming.top().second.At);
    }
    return next;
}

void Medium::SetRate(Time now, std::optional<std::int64_t> bitsPerSecond)
{
    Checked(bitsPerSecond);
    now = Run(now);
    if (_air && _rate)
    {
        _air->Left -= (now - _air->Since).count() * *_rate;
        _air->Since = now;
    }
    _rate = bitsPerSecond;
    if (_air)
    {
        _air->Ends = EndOf(_air->Since, _air->Left);
    }
    Run(now);
}

void Medium::SetOutage(Time now, bool on)
{
    Run(now);
    _out = on;
    if (_air && on)
    {
        _air->Spoiled = true;
    }
}

void Medium::SetLink(Time now, std::size_t from, std::size_t to, const LinkSettings &settings)
{
    if (from >= Count() || to >= Count() || settings.Loss < 0 || settings.Loss > 1 ||
        settings.Duplicate < 0 || settings.Duplicate > 1 || settings.Delay < Time{0} ||
        settings.Jitter < Time{0})
    {
        throw std::invalid_argument(
            "a link is between two nodes, with a loss and a share of duplicates from 0 to 1 and times of at "
            "least 0");
    }
    Run(now);
    LinkAt(from, to).Settings = settings;
}

const LinkSettings &Medium::LinkOf(std::size_t from, std::size_t to) const
{
    return _links.at(from * _nodes.size() + to).Settings;
}

Time Medium::QueueAge(Time now, std::size_t node) const
{
    return _nodes.at(node).Queue.Age(std::max(now, _now));
}

Time Medium::Busy(Time now) const
{
    return _busy + (_air ? std::clamp(now, _air->Began, _air->Ends) - _air->Began : Time{0});
}

void Medium::Reset(Time now)
{
    now = Run(now);
    for (Node &node : _nodes)
    {
        node.Counters = {};
    }
    _busy = Time{0};
    if (_air)
    {
        _air->Began = now;
    }
    _countedSince = now;
}

// Completes all frames that leave the air until `now`. Each frame starts when the one before it has ended,
// however late the caller is.
Time Medium::Run(Time now)
{
    _now = std::max(_now, now);
    while (_air && _air->Ends <= _now)
    {
        const Time ended = _air->Ends;
        Complete();
        BeginNext(ended);
    }
    return _now;
}

void Medium::BeginNext(Time at)
{
    for (std::size_t turn = 1; turn <= _nodes.size(); ++turn)
    {
        const std::size_t node = (_lastTurn + turn) % _nodes.size();
        if (SendQueue &queue = _nodes[node].Queue; !queue.IsEmpty())
        {
            SendQueue::Waiting first = queue.Pop();
            const auto bits = static_cast<std::int64_t>(first.What->size() + _overhead) * 8;
            _air = OnAir{node,
                         std::move(first.What),
                         _overhead,
                         at - first.Since,
                         at,
                         at,
                         EndOf(at, bits * Nano),
                         bits * Nano,
                         _out};
            _lastTurn = node;
            return;
        }
    }
}

void Medium::Complete()
{
    const OnAir sent = std::move(*_air);
    _air.reset();
    _busy += sent.Ends - sent.Began;
    NodeCounters &counters = _nodes[sent.From].Counters;
    counters.OnAir(sent.Ends, *sent.What, sent.Overhead, sent.Waited);
    if (_tap)
    {
        _tap(sent.Ends, *sent.What);
    }
    if (IsMulticast(*sent.What))
    {
        for (std::size_t to = 0; to < _nodes.size(); ++to)
        {
            if (to != sent.From)
            {
                Reach(sent.From, to, sent);
            }
        }
    }
    else if (const auto found = _byAddress.find(DestinationOf(*sent.What));
             found != _byAddress.end() && found->second != sent.From)
    {
        Reach(sent.From, found->second, sent);
    }
    else
    {
        ++counters.Nobody;
    }
}

void Medium::Reach(std::size_t from, std::size_t to, const OnAir &sent)
{
    Link &link = LinkAt(from, to);
    if (sent.Spoiled || link.Settings.Deaf)
    {
        ++_nodes[to].Counters.Missed;
        return;
    }
    if (link.Settings.Loss > 0 && Random() < link.Settings.Loss)
    {
        ++_nodes[to].Counters.Lost;
        return;
    }
    Arrive(link, to, sent);
    if (link.Settings.Duplicate > 0 && Random() < link.Settings.Duplicate)
    {
        Arrive(link, to, sent);
    }
}

void Medium::Arrive(Link &link, std::size_t to, const OnAir &sent)
{
    Time at = sent.Ends + link.Settings.Delay;
    if (link.Settings.Jitter > Time{0})
    {
        const auto jitter = static_cast<double>(link.Settings.Jitter.count());
        at += Time(static_cast<std::int64_t>(jitter * (2 * Random() - 1)));
        at = std::max(at, sent.Ends);
    }
    if (!_reordering)
    {
        at = std::max(at, link.Last);
    }
    link.Last = std::max(at, link.Last);
    _coming.emplace(_sequence++, Arrival{at, to, sent.What});
}

Time Medium::EndOf(Time since, std::int64_t left) const
{
    return _rate ? since + Time((std::max<std::int64_t>(left, 0) + *_rate - 1) / *_rate) : since;
}

// Returns a number from 0 to below 1. It is the same on every machine, which the distributions of the
// standard do not promise.
double Medium::Random()
{
    return static_cast<double>(_random() >> 11) * 0x1p-53;
}

}  // namespace Rabit::Radio
