#include "queues/LinkRefusals.h"

namespace Rabit
{
namespace
{

// The names come from this process, but a loop may make up new ones for ever.
constexpr std::size_t MostLinks = 1000;

}  // namespace

void LinkRefusals::Add(const LinkName &link, QueueAcceptance verdict, const std::string &reason)
{
    if (_entries.size() >= MostLinks && _entries.count(link) == 0)
    {
        _entries.erase(_entries.begin());
    }
    Entry &entry = _entries[link];
    const bool aboutType =
        verdict == QueueAcceptance::WrongType || verdict == QueueAcceptance::OtherDefinition;
    ++(aboutType ? entry.Type : entry.Unknown);
    entry.Reason = reason;
}

void LinkRefusals::Forgive(const LinkName &link)
{
    const auto found = _entries.find(link);
    if (found != _entries.end())
    {
        found->second.Reason.clear();
    }
}

void LinkRefusals::Report(std::map<LinkName, Gateway::LinkStatus> &rows) const
{
    for (const auto &[link, entry] : _entries)
    {
        rows[link].refused_unknown = entry.Unknown;
        rows[link].refused_type = entry.Type;
    }
}

std::vector<Gateway::Problem> LinkRefusals::Problems() const
{
    std::vector<Gateway::Problem> problems;
    for (const auto &[link, entry] : _entries)
    {
        if (!entry.Reason.empty())
        {
            Gateway::Problem problem;
            problem.subject = "send " + link.first + "/" + link.second;
            problem.node = link.first == "*" ? "" : link.first;
            problem.reason = entry.Reason;
            problems.push_back(problem);
        }
    }
    return problems;
}

}  // namespace Rabit
