#include "manager/NodeSecurity.h"

#include <rabit/base/UtcText.h>
#include <rabit/keys/KeysError.h>

#include <ctime>
#include <filesystem>
#include <utility>

#include "keys/MemberFolder.h"
#include "names/ForeignNames.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{
namespace
{

// From then on a coming end is a problem.
constexpr std::time_t AheadOfTheEnd = 30 * 24 * 60 * 60;

std::string DoesNotAllow(const std::string &permissions, const std::vector<std::string> &lacks, bool isTool)
{
    std::string listed;
    for (const std::string &one : lacks)
    {
        listed += (listed.empty() ? "" : "; ") + one;
    }
    return permissions + " does not allow what the configuration needs: " + listed +
           (isTool ? "; a tool needs keys of its own: `rabit keys add <name> --tool`"
                   : "; `rabit keys renew` with the configuration makes permissions that fit");
}

}  // namespace

Keys::Access AccessOf(const GatewayConfig &config)
{
    Keys::Access access;
    access.Publish = {GatewayTopics::Beat, GatewayTopics::Link};
    if (config.Tool)
    {
        // A tool reads every topic that it is asked to.
        access.Subscribe = {"*"};
        return access;
    }
    access.Subscribe = access.Publish;
    for (const PublishRule &rule : config.Publish)
    {
        access.Publish.push_back(rule.Message);
    }
    for (const SubscribeRule &rule : config.Subscribe)
    {
        access.Subscribe.push_back(rule.Message);
    }
    for (const ForeignRule &rule : config.Foreign)
    {
        (rule.Way == ForeignRule::Direction::Publish ? access.Publish : access.Subscribe)
            .push_back(WireTopicOf(rule));
    }
    return access;
}

std::shared_ptr<FleetMember> NodeMembers::Of(const GatewayConfig &config)
{
    if (config.Security->Member)
    {
        _given.insert(config.Security->Member);
        return config.Security->Member;
    }
    const std::string &folder = config.Security->Keys;
    const std::string stored =
        config.StateDir.empty() ? "" : config.StateDir + "/" + config.Node + ".bulletin";
    const Keys::MemberFolder keys(folder, Keys::KeyPlace::Here, stored);
    if (const std::string why = keys.WhyNot(config.Node); !why.empty())
    {
        throw Keys::KeysError(why);
    }
    if (const auto lacks = keys.Lacks(AccessOf(config)); !lacks.empty())
    {
        throw Keys::KeysError(DoesNotAllow(keys.Files().Permissions, lacks, config.Tool.has_value()));
    }
    Known &known = _known[folder];
    if (!known.Member)
    {
        MadeMember made = MakeFleetMember(keys.Keys());
        if (!made.Member)
        {
            throw Keys::KeysError(folder + ": " + made.Error);
        }
        known = {.Member = std::move(made.Member),
                 .EndsAt = static_cast<std::time_t>(keys.Certificate().Ends)};
    }
    return known.Member;
}

std::vector<SettingsProblem> NodeMembers::Problems(std::time_t now) const
{
    std::vector<SettingsProblem> problems;
    for (const auto &[folder, known] : _known)
    {
        if (!known.Member)
        {
            continue;
        }
        // The member itself tells an end that is over.
        if (now <= known.EndsAt && known.EndsAt - now <= AheadOfTheEnd)
        {
            problems.push_back({.Setting = "keys",
                                .Entry = "",
                                .Text = "the certificate of this node ends on " +
                                        UtcText(known.EndsAt, "%Y-%m-%d") +
                                        ": `rabit keys renew` makes a new one; other nodes go on hearing "
                                        "this one"});
        }
        for (SettingsProblem &problem : known.Member->Problems())
        {
            problems.push_back(std::move(problem));
        }
    }
    for (const auto &member : _given)
    {
        for (SettingsProblem &problem : member->Problems())
        {
            problems.push_back(std::move(problem));
        }
    }
    return problems;
}

void AddSecurity(const GatewayConfig &config, TransportSettings &settings, NodeMembers &members)
{
    if (!config.Security)
    {
        return;
    }
    try
    {
        settings.Member = members.Of(config);
    }
    catch (const Keys::KeysError &error)
    {
        throw TransportError(error.what(), "security");
    }
    catch (const std::filesystem::filesystem_error &error)
    {
        throw TransportError(
            "the folder of keys " + config.Security->Keys + " cannot be read: " + error.code().message(),
            "security");
    }
}

}  // namespace Rabit
