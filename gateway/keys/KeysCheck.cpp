#include "keys/KeysCheck.h"

#include <boost/algorithm/string/join.hpp>

#include <algorithm>

namespace Rabit::Keys
{
namespace
{

constexpr std::time_t Day = 24 * 60 * 60;

bool IsPattern(const std::string &name)
{
    return name.find_first_of("*?[") != std::string::npos;
}

std::string List(const std::vector<std::string> &words)
{
    return boost::algorithm::join(words, ", ");
}

// True for the permissions of a tool: it reads all topics by one pattern, and writes only the gateways' own.
bool IsOfTool(const Permissions::Rule &rule)
{
    const bool readsAll = rule.Subscribe.size() == 1 && rule.Subscribe.front().Topic == "*";
    const bool saysNothing =
        std::all_of(rule.Publish.begin(), rule.Publish.end(),
                    [](const TopicAccess &access) { return access.Topic.starts_with("rabit/"); });
    return readsAll && saysNothing;
}

void AddTooMuch(const Permissions::Rule &rule, const std::string &node, std::vector<KeysFinding> &findings)
{
    const auto add = [&](const std::string &text) { findings.push_back({true, text}); };
    for (const TopicAccess &access : rule.Publish)
    {
        if (IsPattern(access.Topic))
        {
            add("may write topics by the pattern `" + access.Topic + "`; name each one");
        }
        for (const std::string &partition : access.Partitions)
        {
            if (IsPattern(partition))
            {
                add("may write " + access.Topic + " in partitions by the pattern `" + partition +
                    "`, and so in another node's name; name its own");
            }
            else if (!partition.empty() && partition != node)
            {
                add("may write " + access.Topic + " in the partition `" + partition +
                    "`, which is of another node");
            }
        }
    }
    for (const TopicAccess &access : rule.Subscribe)
    {
        if (IsPattern(access.Topic) && !IsOfTool(rule))
        {
            add("may read topics by the pattern `" + access.Topic + "`; name each one");
        }
    }
}

// Adds a line for each group of topics with the same partitions.
void AddWords(const char *verb, std::vector<TopicAccess> entries, const std::string &own,
              std::vector<std::string> &lines)
{
    while (!entries.empty())
    {
        const std::vector<std::string> partitions = entries.front().Partitions;
        std::vector<std::string> topics;
        for (const TopicAccess &entry : entries)
        {
            if (entry.Partitions == partitions)
            {
                topics.push_back(entry.Topic == "*" ? "everything" : entry.Topic);
            }
        }
        std::erase_if(entries, [&](const TopicAccess &entry) { return entry.Partitions == partitions; });
        std::vector<std::string> of = partitions;
        std::erase_if(of, [&](const std::string &name) { return name.empty() || name == own; });
        const bool isAll = std::find(of.begin(), of.end(), "*") != of.end();
        lines.push_back(std::string(verb) + " " + List(topics) +
                        (of.empty() ? ""
                         : isAll    ? " of everybody"
                                    : " of " + List(of)));
    }
}

}  // namespace

std::vector<KeysFinding> WhatIsTooMuch(const NodeKeys &keys)
{
    std::vector<KeysFinding> findings;
    if (keys.Permissions().AllowsTheRest)
    {
        findings.push_back({true, "may do whatever is not forbidden (`<default>ALLOW`); expected DENY"});
    }
    for (const Permissions::Rule &rule : keys.Permissions().Rules)
    {
        if (!rule.Allows)
        {
            continue;
        }
        if (std::any_of(rule.Domains.begin(), rule.Domains.end(),
                        [](const auto &range) { return range.first != range.second; }))
        {
            findings.push_back({true, "may join a range of domains; name each one"});
        }
        AddTooMuch(rule, keys.Subject().Node, findings);
    }
    return findings;
}

std::vector<KeysFinding> WhatEnds(const NodeKeys &keys, std::time_t now, int days)
{
    std::vector<KeysFinding> findings;
    const auto add = [&](const std::string &file, const Validity &validity, const std::string &advice)
    {
        const auto left = (validity.To - now) / Day;
        if (now < validity.From)
        {
            findings.push_back({true, file + "begins on " + MinuteText(validity.From) +
                                          ", and the clock here says " + MinuteText(now)});
        }
        else if (now > validity.To)
        {
            findings.push_back({true, file + "ended on " + DayText(validity.To) + "; " + advice});
        }
        else if (left < days)
        {
            findings.push_back({true, file + "ends on " + DayText(validity.To) + ", in " +
                                          std::to_string(left) + " days; " + advice});
        }
    };
    add("", keys.ValidityOf(), "renew it");
    add("revoked.pem ", keys.ValidityOfRevocations(), "copy the fleet's present one");
    return findings;
}

std::vector<std::string> WhoMayWhat(const NodeKeys &keys)
{
    std::vector<std::string> lines;
    for (const Permissions::Rule &rule : keys.Permissions().Rules)
    {
        std::vector<std::string> domains;
        for (const auto &[from, to] : rule.Domains)
        {
            domains.push_back(std::to_string(from) + (from == to ? "" : " to " + std::to_string(to)));
        }
        const std::string where = (domains.size() == 1 ? "in domain " : "in the domains ") + List(domains);
        lines.push_back(rule.Allows ? where : where + ", is not allowed the following");
        AddWords("writes", rule.Publish, keys.Subject().Node, lines);
        AddWords("reads", rule.Subscribe, "", lines);
    }
    return lines;
}

}  // namespace Rabit::Keys
