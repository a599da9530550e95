#include "queues/RefusalCounts.h"

#include <algorithm>

namespace Rabit
{

RefusalCounts::Entry &RefusalCounts::EntryOf(const LinkName &link)
{
    if (_entries.size() >= MostLinks && _entries.count(link) == 0)
    {
        const auto oldest =
            std::min_element(_entries.begin(), _entries.end(),
                             [](const auto &a, const auto &b) { return a.second.Last < b.second.Last; });
        SetReason(oldest->second, "");
        _entries.erase(oldest);
    }
    return _entries[link];
}

void RefusalCounts::Add(const std::string &node, const std::string &queue, QueueAcceptance acceptance,
                        const std::string &reason, Duration now)
{
    const std::lock_guard lock(_mutex);
    Entry &entry = EntryOf({node, queue});
    const bool aboutType =
        acceptance == QueueAcceptance::WrongType || acceptance == QueueAcceptance::OtherDefinition;
    ++(aboutType ? entry.Type : entry.Unknown);
    SetProblem(entry, acceptance, reason, now);
}

void RefusalCounts::Tell(const std::string &node, const std::string &queue, QueueAcceptance acceptance,
                         const std::string &reason, Duration now)
{
    const std::lock_guard lock(_mutex);
    SetProblem(EntryOf({node, queue}), acceptance, reason, now);
}

void RefusalCounts::SetProblem(Entry &entry, QueueAcceptance acceptance, const std::string &reason,
                               Duration now)
{
    SetReason(entry, reason);
    entry.OtherVersion = acceptance == QueueAcceptance::OtherDefinition;
    entry.Last = now;
}

void RefusalCounts::SetReason(Entry &entry, const std::string &reason)
{
    _reasons += reason.empty() ? 0 : 1;
    _reasons -= entry.Reason.empty() ? 0 : 1;
    entry.Reason = reason;
}

void RefusalCounts::Forgive(const std::string &node, const std::string &queue)
{
    if (_reasons == 0)
    {
        return;
    }
    const std::lock_guard lock(_mutex);
    const auto found = _entries.find({node, queue});
    if (found != _entries.end())
    {
        SetReason(found->second, "");
    }
}

void RefusalCounts::Forget(const std::string &node)
{
    const std::lock_guard lock(_mutex);
    for (auto entry = _entries.begin(); entry != _entries.end();)
    {
        if (entry->first.first == node)
        {
            SetReason(entry->second, "");
            entry = _entries.erase(entry);
        }
        else
        {
            ++entry;
        }
    }
}

void RefusalCounts::Report(std::map<LinkName, Gateway::LinkStatus> &rows) const
{
    const std::lock_guard lock(_mutex);
    for (const auto &[link, entry] : _entries)
    {
        rows[link].refused_unknown = entry.Unknown;
        rows[link].refused_type = entry.Type;
    }
}

std::vector<Gateway::Problem> RefusalCounts::Problems(Duration now) const
{
    const std::lock_guard lock(_mutex);
    std::vector<Gateway::Problem> problems;
    for (const auto &[link, entry] : _entries)
    {
        if (!entry.Reason.empty() && now - entry.Last < Memory)
        {
            problems.push_back({"send " + link.first + "/" + link.second, link.first == "*" ? "" : link.first,
                                entry.Reason, entry.OtherVersion});
        }
    }
    return problems;
}

}  // namespace Rabit
