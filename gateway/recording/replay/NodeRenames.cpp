#include "recording/replay/NodeRenames.h"

#include <rabit/gateway/NamePattern.h>

#include <algorithm>

namespace Rabit::Replay
{
namespace
{

std::ptrdiff_t Stars(std::string_view text)
{
    return std::count(text.begin(), text.end(), '*');
}

// True if the text would be a node name if its `*` were letters.
bool CanBeName(std::string_view text)
{
    std::string name(text);
    std::replace(name.begin(), name.end(), '*', 'x');
    return IsNodeName(name);
}

}  // namespace

std::string NodeRenames::Add(std::string_view rule)
{
    const std::size_t equal = rule.find('=');
    const std::string_view from = rule.substr(0, equal);
    const std::string_view to = equal == std::string_view::npos ? "" : rule.substr(equal + 1);
    std::string shown = "`";
    shown.append(rule).push_back('`');
    if (!CanBeName(from) || !CanBeName(to))
    {
        return shown + " renames no node; expected OLD=NEW, as uav1=replay.uav1";
    }
    if (Stars(from) > 1 || Stars(from) != Stars(to))
    {
        return shown + " is not clear; expected one `*` on both sides, or none";
    }
    _rules.push_back({std::string(from), std::string(to)});
    return {};
}

std::string NodeRenames::NewNameOf(const std::string &node) const
{
    const Rule *rule = Find(node);
    return rule == nullptr ? std::string(Prefix) + node : Apply(*rule, node);
}

std::string NodeRenames::RuledNameOf(const std::string &node) const
{
    const Rule *rule = Find(node);
    return rule == nullptr ? node : Apply(*rule, node);
}

const NodeRenames::Rule *NodeRenames::Find(const std::string &node) const
{
    const auto found = std::find_if(_rules.begin(), _rules.end(),
                                    [&node](const Rule &rule) { return MatchesPattern(rule.From, node); });
    return found == _rules.end() ? nullptr : &*found;
}

std::string NodeRenames::Apply(const Rule &rule, const std::string &node)
{
    const std::size_t star = rule.From.find('*');
    std::string name = rule.To;
    if (star != std::string::npos)
    {
        const std::size_t length = node.size() - (rule.From.size() - 1);
        name.replace(name.find('*'), 1, node.substr(star, length));
    }
    return name;
}

}  // namespace Rabit::Replay
