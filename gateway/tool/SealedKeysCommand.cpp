#include <rabit/base/UtcText.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "Command.h"
#include "KeysDomains.h"
#include "KeysReport.h"
#include "SafeText.h"
#include "SealedKeys.h"
#include "keys/FleetAuthority.h"
#include "keys/KeyFiles.h"
#include "keys/KeysError.h"
#include "keys/MemberCheck.h"
#include "keys/MemberFolder.h"
#include "keys/MemberPermissions.h"
#include "keys/Passphrase.h"
#include "manager/NodeSecurity.h"

namespace Rabit::Tool::SealedKeys
{
namespace
{

Keys::FleetAuthority AuthorityOf(const KeysOptions &options)
{
    if (options.Domain >= 0 || !options.Transport.empty())
    {
        Output::Talk(
            "the keys of this fleet hold in every domain and over every transport: --domain and --transport "
            "change nothing");
    }
    return Keys::FleetAuthority(options.Folder, Keys::PassphraseFrom(options.PassphraseFile));
}

Keys::FleetAuthority::Period PeriodFrom(const KeysOptions &options)
{
    return {.Now = std::time(nullptr), .Days = options.Days};
}

Keys::FleetAuthority::Request RequestFor(const KeysOptions &options, const std::string &node)
{
    GatewayConfig config;
    if (options.Config.empty())
    {
        config.Node = node;
        config.Tool.emplace();
    }
    else
    {
        config = ConfigForKeys(options.Config, node);
    }
    return {.Node = config.Node,
            .Role = config.Tool ? Envelope::CertificateRole::Tool : Envelope::CertificateRole::Node,
            .Allowed = Keys::PermissionsFor(AccessOf(config))};
}

std::string EndOf(const Keys::MemberFolder &member)
{
    return UtcText(static_cast<std::time_t>(member.Certificate().Ends), "%Y-%m-%d");
}

// Tells how the newest bulletin reaches the fleet.
void TellBulletin(const Keys::FleetAuthority &fleet, const std::string &folder)
{
    Output::Talk("the fleet is in epoch " + std::to_string(fleet.Epoch()) + " now: copy " + folder +
                 "/authority/bulletin into the folder of any one node, and start that node; it passes the "
                 "bulletin on to the others in flight");
}

// Prints the new keys and their permissions. `signing`: the request of the node, if it made one; `revoked`:
// how many older certificates were revoked, if that was asked for.
void ShowMadeKeys(const KeysOptions &options, const Keys::FleetAuthority &fleet, const std::string &node,
                  const Keys::MemberRequest *signing = nullptr,
                  std::optional<std::size_t> revoked = std::nullopt)
{
    const std::string folder = fleet.FolderOf(node);
    const Keys::MemberFolder member(folder, Keys::KeyPlace::HereOrOnNode);
    const std::vector<std::string> may = Keys::WhoMayWhat(member.Allowed());
    if (options.Json)
    {
        Json object{{"node", node}, {"folder", folder}, {"until", EndOf(member)}, {"may", may}};
        if (signing != nullptr)
        {
            object["key"] = signing->Keys.Fingerprint();
        }
        if (revoked)
        {
            object["revoked"] = *revoked;
        }
        Output::Object(object);
    }
    else
    {
        Output::Line(folder + ": valid until " + EndOf(member));
        for (const std::string &line : may)
        {
            Output::Line("  " + SafeText(line));
        }
        if (signing != nullptr)
        {
            Output::Line("  key " + signing->Keys.Fingerprint());
        }
    }
    if (signing != nullptr)
    {
        Output::Talk("the author of the request is now " + node +
                     ": compare the key with the one that `rabit keys request` printed there");
    }
    const bool isTool = member.Certificate().Role == Envelope::CertificateRole::Tool;
    Output::Talk((member.HasKey() ? "copy the folder to " + node + " by a way that nobody else can read, and "
                                  : "copy the files in the folder into the folder on " + node +
                                        " that has its private key (they are not secret), and ") +
                 (isTool ? "look at the fleet with `rabit nodes --domain N --keys <the folder there>`"
                         : "write `security: {keys: <the folder there>}` into its configuration"));
    if (revoked)
    {
        Output::Talk(std::to_string(*revoked) + (*revoked == 1
                                                     ? " older certificate of " + node + " is revoked"
                                                     : " older certificates of " + node + " are revoked"));
        TellBulletin(fleet, options.Folder);
    }
}

Keys::MemberRequest MemberRequestIn(const std::string &file)
{
    return Keys::ReadMemberRequest(Keys::ReadFile(file), file);
}

std::vector<Keys::KeysFinding> FindingsFor(const Keys::MemberFolder &member, const GatewayConfig *config,
                                           int ahead)
{
    const Envelope::Certificate &certificate = member.Certificate();
    std::vector<Keys::KeysFinding> findings = Keys::WhatEnds(certificate, std::time(nullptr), ahead);
    const auto tooMuch = Keys::WhatIsTooMuch(certificate, member.Allowed());
    findings.insert(findings.end(), tooMuch.begin(), tooMuch.end());
    const std::string node = config == nullptr ? certificate.Name : config->Node;
    if (const std::string why = member.WhyNot(node); !why.empty())
    {
        findings.push_back({true, why});
    }
    if (config == nullptr)
    {
        return findings;
    }
    const Keys::Access access = AccessOf(*config);
    for (const std::string &one : member.Lacks(access))
    {
        findings.push_back({true, "may not " + one + ", which " + config->File + " wants; renew it"});
    }
    const auto needs = Keys::PermissionsFor(access);
    for (const auto &rule : member.Allowed().Rules())
    {
        const auto need = std::find_if(needs.Rules().begin(), needs.Rules().end(),
                                       [&rule](const auto &one) { return one.Topic == rule.Topic; });
        const bool isKnown = need != needs.Rules().end();
        if (rule.MayWrite && !(isKnown && need->MayWrite))
        {
            findings.push_back(
                {true, "may write " + rule.Topic + ", which " + config->File + " does not want; renew it"});
        }
        if (rule.MayRead && !(isKnown && need->MayRead))
        {
            findings.push_back(
                {false, "may read " + rule.Topic + ", which " + config->File + " does not want"});
        }
    }
    return findings;
}

// Reports on one node's folder; returns true if it is good. `fleet`: that of the authority, beside which the
// folder may lack the private key; null: there is none.
bool CheckMember(const std::string &folder, const std::map<std::string, GatewayConfig> &configs,
                 const KeysCheckOptions &options, const Keys::FleetAuthority *fleet)
{
    KeysReport report{.Node = std::filesystem::path(folder).filename().string(),
                      .Folder = folder,
                      .Until = "",
                      .May = {},
                      .Findings = {}};
    try
    {
        const std::filesystem::path parent = std::filesystem::weakly_canonical(folder).parent_path();
        const bool isBesideAuthority = Keys::FleetAuthority::IsIn(parent.string());
        const Keys::MemberFolder member(
            folder, isBesideAuthority ? Keys::KeyPlace::HereOrOnNode : Keys::KeyPlace::Here);
        report.Node = member.Certificate().Name;
        report.Until = EndOf(member);
        report.May = Keys::WhoMayWhat(member.Allowed());
        const auto config = configs.find(report.Node);
        report.Findings =
            FindingsFor(member, config == configs.end() ? nullptr : &config->second, options.Ahead);
        if (!member.HasKey())
        {
            report.Findings.push_back({false, "its private key is on the node alone"});
        }
        if (fleet != nullptr && member.Epoch() < fleet->Epoch())
        {
            report.Findings.push_back({true, "its bulletin is of epoch " + std::to_string(member.Epoch()) +
                                                 ", and the fleet is in epoch " +
                                                 std::to_string(fleet->Epoch()) +
                                                 "; copy authority/bulletin into the folder"});
        }
    }
    catch (const Keys::KeysError &error)
    {
        report.Findings.push_back({true, error.what()});
    }
    return Print(report, options.Json);
}

}  // namespace

bool AreIn(const std::string &folder)
{
    return Keys::FleetAuthority::IsIn(folder) || Keys::MemberFiles::AreIn(folder);
}

int Init(const KeysOptions &options)
{
    std::optional<Keys::Secret> passphrase = Keys::GivenPassphrase(options.PassphraseFile);
    if (!passphrase && options.AsksForPassphrase)
    {
        passphrase =
            Keys::TypedPassphrase("New passphrase of the authority in " + options.Folder + ": ", true);
    }
    Keys::FleetAuthority::Init(options.Folder, passphrase ? passphrase->Text() : std::string_view());
    Output::ObjectOrLine(
        options.Json, Json{{"folder", options.Folder}, {"encrypted", passphrase.has_value()}},
        options.Folder + ": a new fleet" + (passphrase ? ", private key of the authority encrypted" : ""));
    Output::Talk("keep " + options.Folder +
                 "/authority where no node and no network reaches it: who has it can make keys for anybody");
    return Good;
}

int Add(const KeysOptions &options)
{
    const Keys::FleetAuthority fleet = AuthorityOf(options);
    fleet.Add(RequestFor(options, options.Node), PeriodFrom(options));
    ShowMadeKeys(options, fleet, options.Node);
    return Good;
}

int Request(const KeysOptions &options)
{
    const Keys::RequestedMember made = Keys::RequestMember(options.Folder, options.Node);
    Output::ObjectOrLine(options.Json,
                         Json{{"node", options.Node},
                              {"folder", options.Folder},
                              {"request", made.File},
                              {"key", made.Fingerprint}},
                         made.File + ": key " + made.Fingerprint);
    Output::Talk(
        "the private key stays here; copy the request to the fleet's folder of keys, and sign it there "
        "with `rabit keys sign " +
        options.Node + ".request.pem --config FILE`");
    return Good;
}

int Sign(const KeysOptions &options)
{
    // All are read before the first is signed.
    std::vector<Keys::MemberRequest> requests;
    for (const std::string &file : options.Requests)
    {
        requests.push_back(MemberRequestIn(file));
    }
    const Keys::FleetAuthority fleet = AuthorityOf(options);
    for (const Keys::MemberRequest &signing : requests)
    {
        fleet.Add(RequestFor(options, signing.Node), PeriodFrom(options), &signing);
        ShowMadeKeys(options, fleet, signing.Node, &signing);
    }
    return Good;
}

int Renew(const KeysOptions &options)
{
    std::optional<Keys::MemberRequest> signing;
    if (!options.Requests.empty())
    {
        signing = MemberRequestIn(options.Requests.front());
    }
    const Keys::MemberRequest *request = signing ? &*signing : nullptr;
    const Keys::FleetAuthority fleet = AuthorityOf(options);
    if (options.RevokeOld)
    {
        for (const std::string &node : options.Nodes)
        {
            fleet.CheckNewKey(node, request);
        }
    }
    for (const std::string &node : options.Nodes)
    {
        fleet.Renew(options.Config.empty() ? fleet.RequestOf(node) : RequestFor(options, node),
                    PeriodFrom(options), request);
        std::optional<std::size_t> revoked;
        if (options.RevokeOld)
        {
            revoked = fleet.RevokeOlder(node, std::time(nullptr));
        }
        ShowMadeKeys(options, fleet, node, request, revoked);
    }
    return Good;
}

int Revoke(const KeysOptions &options)
{
    const Keys::FleetAuthority fleet = AuthorityOf(options);
    const std::size_t count = fleet.Revoke(options.Node, std::time(nullptr));
    Output::ObjectOrLine(options.Json, Json{{"node", options.Node}, {"revoked", count}},
                         options.Node + ": " + std::to_string(count) +
                             (count == 1 ? " certificate is revoked" : " certificates are revoked"));
    Output::Talk("the folder " + fleet.FolderOf(options.Node) + " is removed");
    TellBulletin(fleet, options.Folder);
    return Good;
}

int Check(const KeysCheckOptions &options)
{
    const std::map<std::string, GatewayConfig> configs = ConfigsOf(options);
    if (!Keys::FleetAuthority::IsIn(options.Folder))
    {
        return CheckMember(options.Folder, configs, options, nullptr) ? Good : ProblemFound;
    }
    const Keys::FleetAuthority fleet(options.Folder);
    bool isGood = true;
    for (const std::string &node : fleet.Nodes())
    {
        isGood = CheckMember(fleet.FolderOf(node), configs, options, &fleet) && isGood;
    }
    for (const std::string &node : options.Json ? std::vector<std::string>() : fleet.Revoked())
    {
        if (!std::filesystem::exists(fleet.FolderOf(node)))
        {
            Output::Line(SafeText(node) + ": revoked");
        }
    }
    return AllHaveKeys(configs, options.Folder) && isGood ? Good : ProblemFound;
}

}  // namespace Rabit::Tool::SealedKeys
