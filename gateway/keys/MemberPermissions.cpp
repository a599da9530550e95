#include "keys/MemberPermissions.h"

#include <rabit/keys/KeysError.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace Rabit::Keys
{
namespace
{

void AllowTopics(const std::vector<std::string> &topics, bool Envelope::Permissions::Rule::*what,
                 std::vector<Envelope::Permissions::Rule> &rules)
{
    for (const std::string &topic : topics)
    {
        auto rule = std::find_if(rules.begin(), rules.end(),
                                 [&topic](const auto &one) { return one.Topic == topic; });
        if (rule == rules.end())
        {
            rule = rules.insert(rules.end(), Envelope::Permissions::Rule{.Topic = topic});
        }
        (*rule).*what = true;
    }
}

}  // namespace

Envelope::Permissions PermissionsFor(const Access &access)
{
    std::vector<Envelope::Permissions::Rule> rules;
    AllowTopics(access.Publish, &Envelope::Permissions::Rule::MayWrite, rules);
    AllowTopics(access.Subscribe, &Envelope::Permissions::Rule::MayRead, rules);
    const std::size_t count = rules.size();
    std::optional<Envelope::Permissions> list = Envelope::Permissions::Of(std::move(rules));
    if (!list)
    {
        throw KeysError(
            "the node needs " + std::to_string(count) + " topics, and permissions have room for " +
            std::to_string(Envelope::Permissions::MostRules) + " in " +
            std::to_string(Envelope::Permissions::LargestList / 1024) + " KiB: too many topics for one node");
    }
    return std::move(*list);
}

std::vector<std::string> Lacks(const Envelope::Permissions &list, Envelope::CertificateRole role,
                               const Access &access)
{
    std::vector<std::string> lacks;
    for (const std::string &topic : access.Publish)
    {
        if (!list.MayWrite(topic, role))
        {
            lacks.push_back("write " + topic);
        }
    }
    for (const std::string &topic : access.Subscribe)
    {
        if (!list.MayRead(topic))
        {
            lacks.push_back("read " + topic);
        }
    }
    return lacks;
}

}  // namespace Rabit::Keys
