#include "queues/SendOptions.h"

#include <rabit/gateway/NamePattern.h>

#include <algorithm>

namespace Rabit
{

const SendRule *FindSendRule(const std::vector<SendRule> &rules, std::string_view node,
                             std::string_view queue)
{
    const auto rule = std::find_if(
        rules.begin(), rules.end(),
        [node, queue](const SendRule &candidate)
        { return MatchesPattern(candidate.To, node) && MatchesPattern(candidate.Queue, queue); });
    return rule == rules.end() ? nullptr : &*rule;
}

LinkOptions SendOptions(const std::vector<SendRule> &rules, std::string_view node, std::string_view queue)
{
    LinkOptions options;
    if (const SendRule *rule = FindSendRule(rules, node, queue))
    {
        options.Capacity = rule->Capacity;
        options.CapacityBytes = rule->CapacityBytes;
        options.Expire = rule->Expire;
        options.Window = rule->Window;
        options.RedeliverInDoubt = rule->RedeliverInDoubt;
    }
    return options;
}

}  // namespace Rabit
