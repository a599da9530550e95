#include "manager/NodeSecurity.h"

#include <ctime>

#include "keys/KeysError.h"
#include "keys/NodeKeys.h"
#include "names/ForeignNames.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{

Keys::Access AccessOf(const GatewayConfig &config)
{
    const std::vector<std::string> defaultPartition{""};
    Keys::Access access;
    access.Domain = config.Domain;
    access.Publish = {{GatewayTopics::Beat, defaultPartition}, {GatewayTopics::Link, defaultPartition}};
    if (config.Tool)
    {
        // A tool reads every topic that it is asked to.
        access.Subscribe = {{"*", {"", "*"}}};
        return access;
    }
    access.Subscribe = access.Publish;
    for (const PublishRule &rule : config.Publish)
    {
        access.Publish.push_back({rule.Message, {"", config.Node}});
    }
    for (const SubscribeRule &rule : config.Subscribe)
    {
        access.Subscribe.push_back({rule.Message, rule.From});
    }
    for (const ForeignRule &rule : config.Foreign)
    {
        (rule.Way == ForeignRule::Direction::Publish ? access.Publish : access.Subscribe)
            .push_back({WireTopicOf(rule), defaultPartition});
    }
    return access;
}

std::optional<std::time_t> AddSecurity(const GatewayConfig &config, const std::string &transport,
                                       TransportSettings &settings)
{
    if (!config.Security)
    {
        return std::nullopt;
    }
    const auto fail = [](const std::string &why) { throw TransportError(why, "security"); };
    try
    {
        const Keys::NodeKeys keys(config.Security->Keys);
        if (const std::string why = keys.WhyNot(config.Node, transport, config.Domain, std::time(nullptr));
            !why.empty())
        {
            fail(why);
        }
        std::string lacks;
        for (const std::string &one : keys.Lacks(AccessOf(config)))
        {
            lacks += (lacks.empty() ? "" : "; ") + one;
        }
        if (!lacks.empty())
        {
            fail(keys.Files().Permissions + " does not allow what the configuration needs: " + lacks +
                 (config.Tool ? "; a tool needs keys of its own: `rabit keys add <name> --tool`"
                              : "; `rabit keys renew` with the configuration makes permissions that fit"));
        }
        const Keys::NodeFiles &files = keys.Files();
        const bool encrypts = config.Security->Level == SecurityLevel::Encrypt;
        settings.Security = {
            .IdentityAuthority = files.IdentityAuthority,
            .PermissionsAuthority = files.PermissionsAuthority,
            .Certificate = files.Certificate,
            .PrivateKey = files.PrivateKey,
            .Revoked = files.Revoked,
            .Governance = files.Governance(encrypts ? Keys::Level::Encrypt : Keys::Level::Sign),
            .Permissions = files.Permissions,
            .Encrypts = encrypts,
            .MayBe = [fleet = keys.Subject().Fleet](std::string_view node,
                                                    std::span<const std::uint8_t, 12> guidPrefix)
            { return Keys::IsGuidOf(fleet, node, guidPrefix); }};
        return keys.ValidityOf().To;
    }
    catch (const Keys::KeysError &error)
    {
        throw TransportError(error.what(), "security");
    }
}

std::optional<Gateway::Problem> KeysProblem(std::optional<std::time_t> endsAt, std::time_t now)
{
    constexpr std::time_t ahead = 30 * 24 * 60 * 60;
    if (!endsAt || *endsAt - now > ahead)
    {
        return std::nullopt;
    }
    return Gateway::Problem{
        "keys", "",
        "the certificate of this node " +
            (now > *endsAt
                 ? "ended on " + Keys::DayText(*endsAt) + ": who comes now does not let it in"
                 : "ends on " + Keys::DayText(*endsAt) + ": from then on who comes does not let it in") +
            "; `rabit keys renew` makes a new one",
        true};
}

}  // namespace Rabit
