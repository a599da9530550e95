// rabit keys: makes the keys, certificates and permissions of a fleet, and reports their problems.
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "Command.h"
#include "CommonOptions.h"
#include "Output.h"
#include "SafeText.h"
#include "keys/FleetKeys.h"
#include "keys/KeyFiles.h"
#include "keys/KeysCheck.h"
#include "keys/KeysError.h"
#include "keys/Passphrase.h"
#include "keys/SigningRequest.h"
#include "manager/NodeSecurity.h"

namespace Rabit::Tool
{
namespace
{

using Json = nlohmann::ordered_json;

struct Options
{
    std::string Folder = "keys";
    std::string FleetName = "fleet";
    std::string Node;
    std::vector<std::string> Nodes;
    std::string Config;
    std::vector<std::string> Configs;
    std::vector<std::string> Requests;
    std::string PassphraseFile;
    std::string Transport;
    int Domain = -1;  // the file's, or for a tool that of the fleet
    int Days = 365;
    int Ahead = 30;
    bool ForTool = false;
    bool RevokeOld = false;
    bool AsksForPassphrase = false;
    bool Json = false;
};

Keys::FleetKeys FleetOf(const Options &options)
{
    return Keys::FleetKeys(options.Folder, Keys::PassphraseFrom(options.PassphraseFile));
}

Keys::FleetKeys::Period PeriodOf(const Options &options)
{
    return {std::time(nullptr), options.Days};
}

GatewayConfig ConfigFor(const std::string &file, const std::string &node)
{
    // Any type name will do: types do not matter to keys.
    return LoadGatewayConfig(file, node, [](const std::string &) { return std::string(); });
}

Keys::FleetKeys::Request RequestFrom(const GatewayConfig &config)
{
    return {.Node = config.Node, .Transport = config.Transport, .Access = AccessOf(config)};
}

// The domain that the keys are for; -1: none, or several.
int DomainOf(const Keys::NodeKeys &keys)
{
    const auto &rules = keys.Permissions().Rules;
    const bool isOne = !rules.empty() && rules.front().Domains.size() == 1 &&
                       rules.front().Domains.front().first == rules.front().Domains.front().second;
    return isOne ? rules.front().Domains.front().first : -1;
}

// How many nodes of the fleet have keys for which domain.
std::map<int, std::size_t> DomainsOf(const Keys::FleetKeys &fleet)
{
    std::map<int, std::size_t> domains;
    for (const std::string &node : fleet.Nodes())
    {
        try
        {
            ++domains[DomainOf(Keys::NodeKeys(fleet.FolderOf(node), Keys::PrivateKeyPlace::HereOrOnNode))];
        }
        catch (const Keys::KeysError &)
        {
            // `rabit keys check` reports it.
        }
    }
    domains.erase(-1);
    return domains;
}

// Returns the domain of the most nodes; -1 if two domains have equally many, or none has any.
int UsualDomainOf(const Keys::FleetKeys &fleet)
{
    const std::map<int, std::size_t> domains = DomainsOf(fleet);
    const auto most =
        std::max_element(domains.begin(), domains.end(),
                         [](const auto &one, const auto &other) { return one.second < other.second; });
    const auto same = std::count_if(domains.begin(), domains.end(),
                                    [&](const auto &one) { return one.second == most->second; });
    return same == 1 ? most->first : -1;
}

Keys::FleetKeys::Request RequestOf(const Options &options, const Keys::FleetKeys &fleet,
                                   const std::string &node)
{
    GatewayConfig config;
    if (!options.Config.empty())
    {
        config = ConfigFor(options.Config, node);
    }
    else
    {
        config.Node = node;
        config.Tool.emplace();
        const std::map<int, std::size_t> domains = DomainsOf(fleet);
        if (options.Domain < 0 && domains.size() != 1)
        {
            throw Keys::KeysError(std::string(domains.empty()
                                                  ? "no node of the fleet has keys yet"
                                                  : "the nodes of the fleet are in several domains") +
                                  "; give the tool's with --domain");
        }
        config.Domain = options.Domain < 0 ? domains.begin()->first : options.Domain;
    }
    if (options.Domain >= 0)
    {
        config.Domain = options.Domain;
    }
    if (!options.Transport.empty())
    {
        config.Transport = options.Transport;
    }
    ValidateTransportName(config, AvailableTransports(), KnownTransports());
    return RequestFrom(config);
}

Keys::SigningRequest SigningRequestIn(const std::string &file)
{
    return Keys::ReadSigningRequest(Keys::ReadFile(file), file);
}

// Prints the new keys and their permissions. `signing`: the request of the node, if it made one; `revoked`:
// how many older certificates were revoked, if that was asked for.
void ShowMade(const Options &options, const Keys::FleetKeys &fleet, const std::string &node,
              const Keys::SigningRequest *signing = nullptr,
              std::optional<std::size_t> revoked = std::nullopt)
{
    const std::string folder = fleet.FolderOf(node);
    const Keys::NodeKeys keys(folder, Keys::PrivateKeyPlace::HereOrOnNode);
    const std::string until = Keys::DayText(keys.ValidityOf().To);
    const std::vector<std::string> may = Keys::WhoMayWhat(keys);
    if (options.Json)
    {
        Json object{{"node", node}, {"folder", folder}, {"until", until}, {"may", may}};
        if (signing != nullptr)
        {
            object["key"] = Keys::FingerprintOf(*signing->PublicKey);
        }
        if (revoked)
        {
            object["revoked"] = *revoked;
        }
        Output::Object(object);
    }
    else
    {
        Output::Line(folder + ": valid until " + until);
        for (const std::string &line : may)
        {
            Output::Line("  " + SafeText(line));
        }
        if (signing != nullptr)
        {
            Output::Line("  key " + Keys::FingerprintOf(*signing->PublicKey));
        }
    }
    if (signing != nullptr)
    {
        Output::Talk("the author of the request is now " + node +
                     ": compare the key with the one that `rabit keys request` printed there");
    }
    Output::Talk((keys.HasPrivateKey()
                      ? "copy the folder to " + node + " by a way that nobody else can read, and "
                      : "copy the files in the folder into the folder on " + node +
                            " that has its private key (they are not secret), and ") +
                 (options.ForTool ? "look at the fleet in domain " + std::to_string(DomainOf(keys)) +
                                        " with `rabit nodes --keys <the folder there>`"
                                  : "write `security: {keys: <the folder there>}` into its configuration"));
    if (revoked)
    {
        Output::Talk(std::to_string(*revoked) +
                     (*revoked == 1 ? " older certificate of " + node + " is revoked"
                                    : " older certificates of " + node + " are revoked") +
                     ": copy revoked.pem to all nodes, and start them again");
    }
}

int Init(const Options &options)
{
    std::optional<Keys::Secret> passphrase = Keys::GivenPassphrase(options.PassphraseFile);
    if (!passphrase && options.AsksForPassphrase)
    {
        passphrase =
            Keys::TypedPassphrase("New passphrase of the authorities in " + options.Folder + ": ", true);
    }
    Keys::FleetKeys::Init(options.Folder, options.FleetName, PeriodOf(options),
                          passphrase ? passphrase->Text() : std::string_view());
    const Keys::FleetKeys fleet(options.Folder);
    const std::string until = Keys::DayText(fleet.EndsAt());
    if (options.Json)
    {
        Output::Object(Json{{"folder", options.Folder},
                            {"fleet", fleet.Fleet()},
                            {"until", until},
                            {"encrypted", passphrase.has_value()}});
    }
    else
    {
        Output::Line(options.Folder + ": fleet `" + fleet.Fleet() + "`, valid until " + until +
                     (passphrase ? ", private keys of the authorities encrypted" : ""));
    }
    Output::Talk("keep " + options.Folder +
                 "/authority where no node and no network reaches it: who has it can make keys for anybody");
    return Good;
}

int Add(const Options &options)
{
    const Keys::FleetKeys fleet = FleetOf(options);
    fleet.Add(RequestOf(options, fleet, options.Node), PeriodOf(options));
    ShowMade(options, fleet, options.Node);
    return Good;
}

int Request(const Options &options)
{
    const Keys::RequestedKeys made = Keys::RequestKeys(options.Folder, options.Node);
    if (options.Json)
    {
        Output::Object(Json{{"node", options.Node},
                            {"folder", options.Folder},
                            {"request", made.File},
                            {"key", made.Fingerprint}});
    }
    else
    {
        Output::Line(made.File + ": key " + made.Fingerprint);
    }
    Output::Talk(
        "the private key stays here; copy the request to the fleet's folder of keys, and sign it there "
        "with `rabit keys sign " +
        options.Node + ".request.pem --config FILE`");
    return Good;
}

int Sign(const Options &options)
{
    // All are read before the first is signed.
    std::vector<Keys::SigningRequest> requests;
    for (const std::string &file : options.Requests)
    {
        requests.push_back(SigningRequestIn(file));
    }
    const Keys::FleetKeys fleet = FleetOf(options);
    for (const Keys::SigningRequest &signing : requests)
    {
        fleet.Add(RequestOf(options, fleet, signing.Node), PeriodOf(options), &signing);
        ShowMade(options, fleet, signing.Node, &signing);
    }
    return Good;
}

int Renew(const Options &options)
{
    std::optional<Keys::SigningRequest> signing;
    if (!options.Requests.empty())
    {
        signing = SigningRequestIn(options.Requests.front());
    }
    const Keys::SigningRequest *request = signing ? &*signing : nullptr;
    const Keys::FleetKeys fleet = FleetOf(options);
    if (options.RevokeOld)
    {
        std::for_each(options.Nodes.begin(), options.Nodes.end(),
                      [&](const std::string &node) { fleet.CheckNewKey(node, request); });
    }
    for (const std::string &node : options.Nodes)
    {
        Keys::FleetKeys::Request access =
            options.Config.empty() ? fleet.RequestOf(node) : RequestOf(options, fleet, node);
        if (!options.Transport.empty())
        {
            access.Transport = options.Transport;
        }
        fleet.Renew(access, PeriodOf(options), request);
        std::optional<std::size_t> revoked;
        if (options.RevokeOld)
        {
            revoked = fleet.RevokeOlder(node, std::time(nullptr));
        }
        ShowMade(options, fleet, node, request, revoked);
    }
    return Good;
}

int Revoke(const Options &options)
{
    const Keys::FleetKeys fleet = FleetOf(options);
    const std::size_t count = fleet.Revoke(options.Node, std::time(nullptr));
    if (options.Json)
    {
        Output::Object(Json{{"node", options.Node}, {"revoked", count}});
    }
    else
    {
        Output::Line(options.Node + ": " + std::to_string(count) +
                     (count == 1 ? " certificate is revoked" : " certificates are revoked"));
    }
    Output::Talk("the folder " + fleet.FolderOf(options.Node) + " is removed");
    Output::Talk("each node believes " + options.Node +
                 " until it has its new revoked.pem and is started again; copy to each node:");
    for (const std::string &node : fleet.Nodes())
    {
        Output::Talk("    " + fleet.FolderOf(node) + "/revoked.pem");
    }
    return Good;
}

std::vector<Keys::KeysFinding> FindingsOf(const Keys::NodeKeys &keys, const GatewayConfig *config, int ahead)
{
    std::vector<Keys::KeysFinding> findings = Keys::WhatEnds(keys, std::time(nullptr), ahead);
    const auto tooMuch = Keys::WhatIsTooMuch(keys);
    findings.insert(findings.end(), tooMuch.begin(), tooMuch.end());
    if (config == nullptr)
    {
        return findings;
    }
    if (const std::string why = keys.WhyNever(config->Node, config->Transport, config->Domain); !why.empty())
    {
        findings.push_back({true, why});
    }
    const Keys::Access needs = AccessOf(*config);
    for (const std::string &one : keys.Lacks(needs))
    {
        findings.push_back({true, "may not " + one + ", which " + config->File + " wants; renew it"});
    }
    const auto isNeeded = [](const std::vector<Keys::TopicAccess> &list, const Keys::TopicAccess &one)
    { return std::find(list.begin(), list.end(), one) != list.end(); };
    for (const Keys::Permissions::Rule &rule : keys.Permissions().Rules)
    {
        for (const Keys::TopicAccess &one : rule.Publish)
        {
            if (rule.Allows && !isNeeded(needs.Publish, one))
            {
                findings.push_back({true, "may write " + one.Topic + ", which " + config->File +
                                              " does not want; renew it"});
            }
        }
        for (const Keys::TopicAccess &one : rule.Subscribe)
        {
            if (rule.Allows && !isNeeded(needs.Subscribe, one))
            {
                findings.push_back(
                    {false, "may read " + one.Topic + " otherwise than " + config->File + " wants"});
            }
        }
    }
    return findings;
}

// Reports on one node's folder; returns true if it is good. Beside the authorities it may lack the private
// key. `usual`: the domain of the other nodes; -1: none.
bool Check(const std::string &folder, const std::map<std::string, GatewayConfig> &configs,
           const Options &options, int usual = -1)
{
    std::string name = std::filesystem::path(folder).filename().string();
    std::vector<Keys::KeysFinding> findings;
    std::vector<std::string> words;
    std::string until;
    try
    {
        const std::filesystem::path parent = std::filesystem::weakly_canonical(folder).parent_path();
        const Keys::NodeKeys keys(folder, Keys::FleetKeys::IsFleet(parent.string())
                                              ? Keys::PrivateKeyPlace::HereOrOnNode
                                              : Keys::PrivateKeyPlace::Here);
        name = keys.Subject().Node;
        until = Keys::DayText(keys.ValidityOf().To);
        words = Keys::WhoMayWhat(keys);
        const auto config = configs.find(name);
        findings = FindingsOf(keys, config == configs.end() ? nullptr : &config->second, options.Ahead);
        if (!keys.HasPrivateKey())
        {
            findings.push_back({false, "its private key is on the node alone"});
        }
        if (usual >= 0 && DomainOf(keys) != usual)
        {
            findings.push_back({false, "most nodes are in domain " + std::to_string(usual)});
        }
    }
    catch (const Keys::KeysError &error)
    {
        findings.push_back({true, error.what()});
    }
    const bool isGood = std::none_of(findings.begin(), findings.end(),
                                     [](const Keys::KeysFinding &finding) { return finding.IsProblem; });
    if (options.Json)
    {
        Json problems = Json::array();
        Json notes = Json::array();
        for (const Keys::KeysFinding &finding : findings)
        {
            (finding.IsProblem ? problems : notes).push_back(finding.Text);
        }
        Output::Object(Json{{"node", name},
                            {"folder", folder},
                            {"until", until},
                            {"may", words},
                            {"problems", problems},
                            {"notes", notes}});
        return isGood;
    }
    Output::Line(SafeText(name) + (until.empty() ? "" : ": valid until " + until));
    for (const std::string &line : words)
    {
        Output::Line("  " + SafeText(line));
    }
    for (const Keys::KeysFinding &finding : findings)
    {
        Output::Line((finding.IsProblem ? "  problem: " : "  note: ") + SafeText(finding.Text));
    }
    return isGood;
}

int CheckAll(const Options &options)
{
    std::map<std::string, GatewayConfig> configs;
    for (const std::string &file : options.Configs)
    {
        GatewayConfig config = ConfigFor(file, "");
        const std::string node = config.Node;
        configs.insert_or_assign(node, std::move(config));
    }
    if (!Keys::FleetKeys::IsFleet(options.Folder))
    {
        return Check(options.Folder, configs, options) ? Good : ProblemFound;
    }
    const Keys::FleetKeys fleet(options.Folder);
    const int usual = UsualDomainOf(fleet);
    bool isGood = true;
    for (const std::string &node : fleet.Nodes())
    {
        isGood = Check(fleet.FolderOf(node), configs, options, usual) && isGood;
    }
    for (const std::string &node : options.Json ? std::vector<std::string>() : fleet.Revoked())
    {
        if (!std::filesystem::exists(fleet.FolderOf(node)))
        {
            Output::Line(SafeText(node) + ": revoked");
        }
    }
    for (const auto &[node, config] : configs)
    {
        if (!std::filesystem::exists(fleet.FolderOf(node)))
        {
            Output::Talk(node + " has no keys; `rabit keys add " + node + " --config " + config.File + "`");
            isGood = false;
        }
    }
    return isGood ? Good : ProblemFound;
}

CLI::Option *AddFolder(CLI::App &command, Options &options)
{
    return command.add_option("--keys", options.Folder, "The fleet's folder")->capture_default_str();
}

void AddDays(CLI::App &command, Options &options, int days)
{
    constexpr int longest = 36500;
    options.Days = days;
    command.add_option("--days", options.Days, "How long they are valid")
        ->check(CLI::Range(1, longest))
        ->capture_default_str();
}

void AddPassphrase(CLI::App &command, Options &options)
{
    command.add_option(
        "--passphrase-file", options.PassphraseFile,
        "Its first line opens the authorities' private keys, or /dev/fd/3 for a pipe; default: "
        "RABIT_KEYS_PASSPHRASE of the environment, or the terminal");
}

// The options that say what a node may do.
void AddAccess(CLI::App &command, Options &options)
{
    CLI::Option *config = command.add_option("--config", options.Config,
                                             "The node's configuration: what it needs is what it may do");
    config->check(CLI::ExistingFile);
    CLI::Option *tool = command.add_flag("--tool", options.ForTool,
                                         "For this program: it may read everything, and publishes nothing");
    config->excludes(tool);
    command
        .add_option("--domain", options.Domain,
                    "DDS domain, in place of the file's; of a tool: that of the fleet")
        ->check(CLI::Range(0, Keys::LargestDomain));
    command.add_option("--transport", options.Transport, "DDS implementation, in place of the file's");
    AddDays(command, options, 365);
}

using Command = int (*)(const Options &);

std::shared_ptr<Options> AddCommand(CLI::App &keys, const char *name, const char *help, Command run,
                                    Chosen &chosen, CLI::App *&command)
{
    auto options = std::make_shared<Options>();
    command = keys.add_subcommand(name, help);
    command->add_flag("--json", options->Json, "One JSON object a line");
    command->callback([options, run, &chosen] { chosen.RunToEnd = [=] { return run(*options); }; });
    return options;
}

// Runs the command if it is told what the nodes may do.
void NeedAccess(CLI::App &command, const std::shared_ptr<Options> &options, Command run, Chosen &chosen)
{
    command.callback(
        [options, run, &chosen]
        {
            if (options->Config.empty() && !options->ForTool)
            {
                throw CLI::RequiredError("--config or --tool");
            }
            chosen.RunToEnd = [options, run] { return run(*options); };
        });
}

}  // namespace

void AddKeysCommand(CLI::App &app, Chosen &chosen)
{
    CLI::App *keys = app.add_subcommand("keys", "Keys, certificates and permissions of a fleet");
    keys->require_subcommand(1);
    CLI::App *command = nullptr;

    auto init = AddCommand(*keys, "init", "Makes the two authorities of a new fleet", &Init, chosen, command);
    AddExamples(*command, {"rabit keys init", "rabit keys init fleet_keys --name survey",
                           "rabit keys init --passphrase --days 365"});
    command->add_option("FOLDER", init->Folder, "Where to")->capture_default_str();
    command->add_option("--name", init->FleetName, "Name of the fleet")->capture_default_str();
    AddDays(*command, *init, 3650);
    command->add_flag("--passphrase", init->AsksForPassphrase,
                      "Asks at the terminal for a passphrase, and encrypts the authorities' private keys");
    command->add_option(
        "--passphrase-file", init->PassphraseFile,
        "Encrypts them with the first line of this file, or of /dev/fd/3 for a pipe; default: "
        "RABIT_KEYS_PASSPHRASE of the environment, if it is set");

    auto add =
        AddCommand(*keys, "add", "Makes a node's key, certificate and permissions", &Add, chosen, command);
    AddExamples(*command,
                {"rabit keys add uav1 --config uav1.yaml", "rabit keys add laptop --tool --domain 7",
                 "rabit keys add uav1 --config uav1.yaml --days 30"});
    command->add_option("NODE", add->Node, "Name of the node")->required();
    AddFolder(*command, *add);
    AddAccess(*command, *add);
    AddPassphrase(*command, *add);
    NeedAccess(*command, add, &Add, chosen);

    auto request = AddCommand(*keys, "request",
                              "On a node: makes its private key, which stays there, and a request for a "
                              "certificate",
                              &Request, chosen, command);
    AddExamples(*command, {"rabit keys request uav1", "rabit keys request uav1 --to /etc/rabit/keys",
                           "rabit keys request uav1 --json"});
    command->add_option("NODE", request->Node, "Name of the node")->required();
    command->add_option("--to", request->Folder, "The node's folder of keys, made if it is not there")
        ->capture_default_str();

    auto sign = AddCommand(*keys, "sign",
                           "Makes certificates and permissions for nodes that made requests: no secret files",
                           &Sign, chosen, command);
    AddExamples(*command, {"rabit keys sign uav1.request.pem --config uav1.yaml",
                           "rabit keys sign uav1.request.pem uav2.request.pem --config uav.yaml",
                           "rabit keys sign laptop.request.pem --tool --domain 7"});
    command->add_option("REQUEST", sign->Requests, "Files that `rabit keys request` made")->required();
    AddFolder(*command, *sign);
    AddAccess(*command, *sign);
    AddPassphrase(*command, *sign);
    NeedAccess(*command, sign, &Sign, chosen);

    auto check = AddCommand(*keys, "check", "What is wrong with keys, and who may do what", &CheckAll, chosen,
                            command);
    AddExamples(*command, {"rabit keys check", "rabit keys check keys --config uav1.yaml",
                           "rabit keys check --ahead 60 --json"});
    command->add_option("FOLDER", check->Folder, "The fleet's folder, or one node's")->capture_default_str();
    command->add_option("--config", check->Configs, "Configurations of nodes, to compare with")
        ->check(CLI::ExistingFile);
    command->add_option("--ahead", check->Ahead, "Days before the end from which on it is a problem")
        ->check(CLI::Range(0, 3650))
        ->capture_default_str();

    auto renew = AddCommand(*keys, "renew", "Makes new ones in place of those that nodes have", &Renew,
                            chosen, command);
    AddExamples(*command, {"rabit keys renew uav1 uav2 --days 30",
                           "rabit keys renew uav1 --config uav1.yaml --revoke-old",
                           "rabit keys renew uav1 --request uav1.request.pem"});
    command->add_option("NODE", renew->Nodes, "Names of the nodes")->required();
    AddFolder(*command, *renew);
    command->add_option("--config", renew->Config, "The node's configuration, if it has changed")
        ->check(CLI::ExistingFile);
    command->add_option("--transport", renew->Transport, "DDS implementation, if it has changed");
    command->add_flag("--revoke-old", renew->RevokeOld,
                      "Revokes the older ones; refused for a node that would keep its key");
    CLI::Option *withRequest =
        command
            ->add_option("--request", renew->Requests,
                         "A request of the node for another key; without it, a node that "
                         "made a request keeps its key")
            ->expected(1);
    AddDays(*command, *renew, 365);
    AddPassphrase(*command, *renew);
    command->callback(
        [renew, withRequest, &chosen]
        {
            if (withRequest->count() > 0 && renew->Nodes.size() > 1)
            {
                throw CLI::ValidationError("--request", "a request is of one node");
            }
            chosen.RunToEnd = [renew] { return Renew(*renew); };
        });

    auto revoke =
        AddCommand(*keys, "revoke", "A node is not to be believed any more", &Revoke, chosen, command);
    AddExamples(*command, {"rabit keys revoke uav3", "rabit keys revoke uav3 --keys fleet_keys",
                           "rabit keys revoke uav3 --json"});
    command->add_option("NODE", revoke->Node, "Name of the node")->required();
    AddFolder(*command, *revoke);
    AddPassphrase(*command, *revoke);
}

}  // namespace Rabit::Tool
