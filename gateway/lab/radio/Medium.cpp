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
    BeginNext(now);
    Run(now);
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
    for (const OnAir &frame : _air)
    {
        next = std::min(next.value_or(frame.Ends), frame.Ends);
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
    for (OnAir &frame : _air)
    {
        if (_rate)
        {
            frame.Left -= (now - frame.Since).count() * *_rate;
            frame.Since = now;
        }
    }
    _rate = bitsPerSecond;
    for (OnAir &frame : _air)
    {
        frame.Ends = EndOf(frame.Since, frame.Left);
    }
    Run(now);
}

void Medium::SetOutage(Time now, bool on)
{
    Run(now);
    _out = on;
    for (OnAir &frame : _air)
    {
        frame.Spoiled = frame.Spoiled || on;
    }
}

void Medium::SetHidden(Time now, std::size_t one, std::size_t other, bool hidden)
{
    if (one >= Count() || other >= Count() || one == other)
    {
        throw std::invalid_argument("two nodes are hidden from each other");
    }
    now = Run(now);
    LinkAt(one, other).Hidden = hidden;
    LinkAt(other, one).Hidden = hidden;
    BeginNext(now);
    Run(now);
}

void Medium::SetLink(Time now, std::size_t from, std::size_t to, const LinkSettings &settings)
{
    if (from >= Count() || to >= Count() || settings.Loss < 0 || settings.Loss > 1 ||
        settings.Duplicate < 0 || settings.Duplicate > 1 || settings.Delay < Time{0} ||
        settings.Jitter < Time{0} || !(settings.Burst >= 0 && settings.Burst <= MostBurst))
    {
        throw std::invalid_argument(
            "a link is between two nodes, with a loss and a share of duplicates from 0 to 1, and times and "
            "bursts of at least 0");
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
    Time last = _busySince;
    for (const OnAir &frame : _air)
    {
        last = std::max(last, frame.Ends);
    }
    return _busy + std::clamp(now, _busySince, last) - _busySince;
}

void Medium::Reset(Time now)
{
    now = Run(now);
    for (Node &node : _nodes)
    {
        node.Counters = {};
    }
    _busy = Time{0};
    _busySince = now;
    _countedSince = now;
}

// Completes all frames that leave the air until `now`. Each frame starts when the one before it has ended,
// however late the caller is.
Time Medium::Run(Time now)
{
    _now = std::max(_now, now);
    for (auto first = FirstToEnd(); first != _air.end() && first->Ends <= _now; first = FirstToEnd())
    {
        const Time ended = first->Ends;
        Complete(first);
        // Frames that end at the same time do not overlap with the next one.
        if (const auto other = FirstToEnd(); other == _air.end() || other->Ends > ended)
        {
            BeginNext(ended);
        }
    }
    return _now;
}

std::vector<Medium::OnAir>::iterator Medium::FirstToEnd()
{
    return std::min_element(_air.begin(), _air.end(),
                            [](const OnAir &a, const OnAir &b) { return a.Ends < b.Ends; });
}

// A node begins no frame while it hears another one.
bool Medium::MaySend(std::size_t node) const
{
    return std::all_of(_air.begin(), _air.end(),
                       [&](const OnAir &frame)
                       { return frame.From != node && _links[frame.From * _nodes.size() + node].Hidden; });
}

void Medium::BeginNext(Time at)
{
    const std::size_t last = _lastTurn;
    for (std::size_t turn = 1; turn <= _nodes.size(); ++turn)
    {
        const std::size_t node = (last + turn) % _nodes.size();
        if (!_nodes[node].Queue.IsEmpty() && MaySend(node))
        {
            Begin(at, node);
        }
    }
}

void Medium::Begin(Time at, std::size_t node)
{
    SendQueue::Waiting first = _nodes[node].Queue.Pop();
    const auto bits = static_cast<std::int64_t>(first.What->size() + _overhead) * 8;
    OnAir next{node, std::move(first.What),  _overhead,   at - first.Since,
               at,   EndOf(at, bits * Nano), bits * Nano, _out,
               {}};
    if (_air.empty())
    {
        _busySince = at;
    }
    for (OnAir &frame : _air)
    {
        frame.With.push_back(node);
        next.With.push_back(frame.From);
    }
    _air.push_back(std::move(next));
    _lastTurn = node;
}

void Medium::Complete(std::vector<OnAir>::iterator frame)
{
    const OnAir sent = std::move(*frame);
    _air.erase(frame);
    if (_air.empty())
    {
        _busy += sent.Ends - _busySince;
        _busySince = sent.Ends;
    }
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
    if (sent.Spoiled || link.Settings.Deaf || link.Hidden)
    {
        ++_nodes[to].Counters.Missed;
        return;
    }
    const auto disturbs = [this, to](std::size_t other)
    {
        const Link &its = LinkAt(other, to);
        return other == to || (!its.Hidden && !its.Settings.Deaf);
    };
    if (std::any_of(sent.With.begin(), sent.With.end(), disturbs))
    {
        ++_nodes[to].Counters.Collided;
        return;
    }
    if (IsLost(link))
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

// In the long run the share `Loss` is lost, in bursts of `Burst` frames on average. A loss near 1 makes the
// bursts longer, since a good link does not last less than a frame.
bool Medium::IsLost(Link &link)
{
    const double loss = link.Settings.Loss;
    if (loss <= 0 || loss >= 1 || link.Settings.Burst <= 1)
    {
        link.Bad = false;
        return loss > 0 && Random() < loss;
    }
    const double burst = std::max(link.Settings.Burst, loss / (1 - loss));
    if (Random() < (link.Bad ? 1 / burst : loss / ((1 - loss) * burst)))
    {
        link.Bad = !link.Bad;
    }
    return link.Bad;
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
