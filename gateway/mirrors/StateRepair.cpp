#include "mirrors/StateRepair.h"

#include <rabit/base/Earliest.h>

#include <algorithm>
#include <utility>

#include "mirrors/StateVersion.h"

namespace Rabit
{
namespace
{

// Largest error of the estimate of another node's clock. A larger one would do no harm up to 73 minutes.
constexpr std::int64_t Slack = 1'000'000'000;

}  // namespace

StateRepair::StateRepair(TakenIn takenIn, RandomSource random)
    : _takenIn(std::move(takenIn)), _random(std::move(random))
{
}

void StateRepair::SetWanted(const std::string &node, std::uint64_t incarnation,
                            const std::vector<Wanted> &wanted)
{
    const bool asked = _asked.contains(node);
    Forget(node);
    if (asked)
    {
        _changed.insert(node);
    }
    if (wanted.empty() || _nodes.size() >= MostNodes)
    {
        return;
    }
    Node &made = _nodes[node];
    made.Incarnation = incarnation;
    made.Changed = asked;
    for (const Wanted &what : wanted)
    {
        Entry entry;
        entry.What = what;
        made.Entries.push_back(entry);
    }
}

void StateRepair::Forget(const std::string &node)
{
    _changed.erase(node);
    const auto found = _nodes.find(node);
    if (found == _nodes.end())
    {
        return;
    }
    if (found->second.Due)
    {
        _due.erase({*found->second.Due, node});
    }
    _asked.erase(node);
    _nodes.erase(found);
}

// A sample later than Stated is newer than the announced version.
bool StateRepair::Has(const std::string &name, const Node &node, const Entry &entry) const
{
    const auto taken = _takenIn(name, node.Incarnation, entry.What.Subscription);
    return taken && (*taken > entry.Stated || StateVersion::Of(*taken) == StateVersion::Of(entry.Stated));
}

void StateRepair::Settle(Node &node, Entry &entry)
{
    entry.Request.Stop();
    node.Changed |= entry.Asked;
    entry.Asked = false;
}

StateRepair::Duration StateRepair::Spread(std::size_t others)
{
    const auto many = static_cast<std::size_t>(LongestSpread / SpreadForOne);
    const Duration most = SpreadForOne * static_cast<std::int64_t>(std::min(others, many));
    return Duration(static_cast<std::int64_t>(_random() % static_cast<std::uint64_t>(most.count() + 1)));
}

void StateRepair::OnTold(const std::string &name, const Told &told, Duration now)
{
    const auto found = _nodes.find(name);
    if (found == _nodes.end() || found->second.Incarnation != told.Incarnation)
    {
        return;
    }
    Node &node = found->second;
    node.RoundTrip = told.RoundTrip;
    for (Entry &entry : node.Entries)
    {
        const std::size_t place = entry.What.State;
        const std::uint32_t version =
            place < told.Versions.size() ? told.Versions[place] : StateVersion::None;
        if (version == StateVersion::None)
        {
            Settle(node, entry);
            continue;
        }
        entry.Stated = StateVersion::LatestOf(version, told.SourceNow + Slack);
        LookAt(name, node, entry, told.Others, now);
        entry.Judged = true;
    }
    Reschedule(name, node);
}

void StateRepair::LookAt(const std::string &name, Node &node, Entry &entry, std::size_t others, Duration now)
{
    if (Has(name, node, entry))
    {
        Settle(node, entry);
    }
    else if (!entry.Request.Due())
    {
        entry.Request.Begin(now + (entry.Judged ? AskAfter : Duration(0)) + Spread(others));
    }
}

void StateRepair::Rest(const std::string &name)
{
    const auto found = _nodes.find(name);
    if (found == _nodes.end())
    {
        return;
    }
    for (Entry &entry : found->second.Entries)
    {
        Settle(found->second, entry);
    }
    Reschedule(name, found->second);
}

// Returns true if a State is to be requested now.
bool StateRepair::Ripen(const std::string &name, Node &node, Duration now)
{
    bool any = false;
    for (Entry &entry : node.Entries)
    {
        if (entry.Request.Due() && Has(name, node, entry))
        {
            Settle(node, entry);
        }
        else if (entry.Request.IsDue(now))
        {
            entry.Asked = true;
            entry.Request.Done(now, node.RoundTrip + AskAfter);
            any = true;
        }
    }
    return any;
}

std::vector<StateRepair::Ask> StateRepair::Take(Duration now)
{
    std::set<std::string> looked = std::exchange(_changed, {});
    looked.insert(_asked.begin(), _asked.end());
    for (auto due = _due.begin(); due != _due.end() && due->first <= now; ++due)
    {
        looked.insert(due->second);
    }
    std::vector<Ask> asks;
    for (const std::string &name : looked)
    {
        const auto found = _nodes.find(name);
        if (found == _nodes.end())
        {
            asks.push_back({name, {}, false});
            continue;
        }
        const bool any = Ripen(name, found->second, now);
        if (any || found->second.Changed)
        {
            asks.push_back(AskOf(name, found->second, any));
        }
        Reschedule(name, found->second);
    }
    return asks;
}

StateRepair::Ask StateRepair::AskOf(const std::string &name, Node &node, bool now)
{
    node.Changed = false;
    Ask ask;
    ask.Node = name;
    ask.Now = now;
    for (const Entry &entry : node.Entries)
    {
        if (entry.Asked)
        {
            ask.States.resize(std::max(ask.States.size(), entry.What.State + 1));
            ask.States[entry.What.State] = true;
        }
    }
    return ask;
}

void StateRepair::Reschedule(const std::string &name, Node &node)
{
    std::optional<Duration> due;
    bool asked = false;
    for (const Entry &entry : node.Entries)
    {
        asked |= entry.Asked;
        due = Earliest({due, entry.Request.Due()});
    }
    if (due != node.Due)
    {
        if (node.Due)
        {
            _due.erase({*node.Due, name});
        }
        if (due)
        {
            _due.insert({*due, name});
        }
        node.Due = due;
    }
    if (asked)
    {
        _asked.insert(name);
    }
    else
    {
        _asked.erase(name);
    }
    if (node.Changed)
    {
        _changed.insert(name);
    }
}

std::optional<StateRepair::Duration> StateRepair::Due() const
{
    return _due.empty() ? std::nullopt : std::optional(_due.begin()->first);
}

}  // namespace Rabit
