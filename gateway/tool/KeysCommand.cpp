// rabit keys: makes the keys, certificates and permissions of a fleet.
#include <cstddef>
#include <ctime>
#include <memory>
#include <optional>

#include "Command.h"
#include "KeysConfig.h"
#include "SafeText.h"
#include "keys/FleetAuthority.h"
#include "keys/KeyFiles.h"
#include "keys/MemberCheck.h"
#include "keys/MemberFolder.h"
#include "keys/MemberPermissions.h"
#include "keys/MemberRequest.h"
#include "keys/Passphrase.h"
#include "manager/NodeSecurity.h"

namespace Rabit::Tool
{
namespace KeysParts
{
namespace
{

// Of all commands but `check`.
struct Options
{
    std::string Folder = "keys";
    std::string Node;
    std::vector<std::string> Nodes;
    std::string Config;
    std::vector<std::string> Requests;
    std::string PassphraseFile;
    int Days = 365;
    bool ForTool = false;
    bool RevokeOld = false;
    bool AsksForPassphrase = false;
    bool Json = false;
};

Keys::FleetAuthority FleetOf(const Options &options)
{
    return Keys::FleetAuthority(options.Folder, Keys::PassphraseFrom(options.PassphraseFile));
}

Keys::FleetAuthority::Period PeriodOf(const Options &options)
{
    return {.Now = std::time(nullptr), .Days = options.Days};
}

Keys::FleetAuthority::Request RequestOf(const Options &options, const std::string &node)
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

Keys::MemberRequest MemberRequestIn(const std::string &file)
{
    return Keys::ReadMemberRequest(Keys::ReadFile(file), file);
}

// Tells how the newest bulletin reaches the fleet.
void TellBulletin(const Keys::FleetAuthority &fleet, const std::string &folder)
{
    Output::Talk("the fleet is in epoch " + std::to_string(fleet.Epoch()) + " now: copy " + folder +
                 "/authority/bulletin into the folder of keys of any one node, and start that node anew; it "
                 "passes the bulletin on to the others in flight");
}

// Prints the new keys and their permissions. `signing`: the request of the node, if it made one; `revoked`:
// how many older certificates were revoked, if that was asked for.
void ShowMade(const Options &options, const Keys::FleetAuthority &fleet, const std::string &node,
              const Keys::MemberRequest *signing = nullptr, std::optional<std::size_t> revoked = std::nullopt)
{
    const std::string folder = fleet.FolderOf(node);
    const Keys::MemberFolder member(folder, Keys::KeyPlace::HereOrOnNode);
    const std::string until = Keys::EndOf(member.Certificate());
    const std::vector<std::string> may = Keys::WhoMayWhat(member.Allowed());
    if (options.Json)
    {
        Json object{{"node", node}, {"folder", folder}, {"until", until}, {"may", may}};
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
        Output::Line(folder + ": valid until " + until);
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

int Init(const Options &options)
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

int Add(const Options &options)
{
    const Keys::FleetAuthority fleet = FleetOf(options);
    fleet.Add(RequestOf(options, options.Node), PeriodOf(options));
    ShowMade(options, fleet, options.Node);
    return Good;
}

int Request(const Options &options)
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

int Sign(const Options &options)
{
    // All are read and checked before the first is signed.
    std::vector<Keys::MemberRequest> requests;
    for (const std::string &file : options.Requests)
    {
        requests.push_back(MemberRequestIn(file));
    }
    const Keys::FleetAuthority fleet = FleetOf(options);
    std::vector<Keys::FleetAuthority::Request> asked;
    for (const Keys::MemberRequest &signing : requests)
    {
        asked.push_back(RequestOf(options, signing.Node));
    }
    fleet.CheckAdd(requests);
    for (std::size_t i = 0; i < requests.size(); ++i)
    {
        fleet.Add(asked[i], PeriodOf(options), &requests[i]);
        ShowMade(options, fleet, requests[i].Node, &requests[i]);
    }
    return Good;
}

int Renew(const Options &options)
{
    std::optional<Keys::MemberRequest> signing;
    if (!options.Requests.empty())
    {
        signing = MemberRequestIn(options.Requests.front());
    }
    const Keys::MemberRequest *request = signing ? &*signing : nullptr;
    const Keys::FleetAuthority fleet = FleetOf(options);
    if (options.RevokeOld)
    {
        for (const std::string &node : options.Nodes)
        {
            fleet.CheckNewKey(node, request);
        }
    }
    for (const std::string &node : options.Nodes)
    {
        fleet.Renew(options.Config.empty() ? fleet.RequestOf(node) : RequestOf(options, node),
                    PeriodOf(options), request);
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
    const Keys::FleetAuthority fleet = FleetOf(options);
    const std::size_t count = fleet.Revoke(options.Node, std::time(nullptr));
    Output::ObjectOrLine(options.Json, Json{{"node", options.Node}, {"revoked", count}},
                         options.Node + ": " + std::to_string(count) +
                             (count == 1 ? " certificate is revoked" : " certificates are revoked"));
    Output::Talk("the folder " + fleet.FolderOf(options.Node) + " is removed");
    TellBulletin(fleet, options.Folder);
    return Good;
}

void AddFolder(CLI::App &command, Options &options)
{
    command.add_option("--keys", options.Folder, "The fleet's folder")->capture_default_str();
}

void AddDays(CLI::App &command, Options &options)
{
    constexpr int longest = 36500;
    command.add_option("--days", options.Days, "How long the certificate is valid")
        ->check(CLI::Range(1, longest))
        ->capture_default_str();
}

void AddPassphrase(CLI::App &command, Options &options)
{
    command.add_option("--passphrase-file", options.PassphraseFile,
                       "Its first line opens the authority's private key, or /dev/fd/3 for a pipe; default: "
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
    AddDays(command, options);
}

std::shared_ptr<Options> AddCommand(CLI::App &keys, const char *name, const char *help,
                                    int (*run)(const Options &), Chosen &chosen, CLI::App *&command,
                                    void (*check)(const Options &) = nullptr)
{
    auto [added, options] = Tool::AddCommand<Options>(keys, chosen, name, help, run, check);
    command = added;
    command->add_flag("--json", options->Json, "One JSON object a line");
    return options;
}

// Makes sure that the line says what the nodes may do.
void CheckAccess(const Options &options)
{
    if (options.Config.empty() && !options.ForTool)
    {
        throw CLI::RequiredError("--config or --tool");
    }
}

void CheckRequest(const Options &options)
{
    if (!options.Requests.empty() && options.Nodes.size() > 1)
    {
        throw CLI::ValidationError("--request", "a request is of one node");
    }
}

}  // namespace
}  // namespace KeysParts

void AddKeysCommand(CLI::App &app, Chosen &chosen)
{
    using namespace KeysParts;
    CLI::App *keys = app.add_subcommand("keys", "Keys, certificates and permissions of a fleet");
    keys->require_subcommand(1);
    CLI::App *command = nullptr;

    auto init = AddCommand(*keys, "init", "Makes the authority of a new fleet", &Init, chosen, command);
    AddExamples(*command, {"rabit keys init", "rabit keys init --passphrase",
                           "rabit keys init fleet_keys --passphrase-file /media/stick/passphrase"});
    command->add_option("FOLDER", init->Folder, "Where to")->capture_default_str();
    command->add_flag("--passphrase", init->AsksForPassphrase,
                      "Asks at the terminal for a passphrase, and encrypts the authority's private key");
    command->add_option("--passphrase-file", init->PassphraseFile,
                        "Encrypts it with the first line of this file, or of /dev/fd/3 for a pipe; default: "
                        "RABIT_KEYS_PASSPHRASE of the environment, if it is set");

    auto add = AddCommand(*keys, "add", "Makes a node's keys, certificate and permissions", &Add, chosen,
                          command, &CheckAccess);
    AddExamples(*command, {"rabit keys add uav1 --config uav1.yaml", "rabit keys add laptop --tool",
                           "rabit keys add uav1 --config uav1.yaml --days 30"});
    command->add_option("NODE", add->Node, "Name of the node")->required();
    AddFolder(*command, *add);
    AddAccess(*command, *add);
    AddPassphrase(*command, *add);

    auto request = AddCommand(*keys, "request",
                              "On a node: makes its private keys, which stay there, and a request for a "
                              "certificate",
                              &Request, chosen, command);
    AddExamples(*command, {"rabit keys request uav1", "rabit keys request uav1 --to /etc/rabit/keys",
                           "rabit keys request uav1 --json"});
    command->add_option("NODE", request->Node, "Name of the node")->required();
    command->add_option("--to", request->Folder, "The node's folder of keys, made if it is not there")
        ->capture_default_str();

    auto sign = AddCommand(*keys, "sign",
                           "Makes certificates and permissions for nodes that made requests: no secret files",
                           &Sign, chosen, command, &CheckAccess);
    AddExamples(*command, {"rabit keys sign uav1.request.pem --config uav1.yaml",
                           "rabit keys sign uav1.request.pem uav2.request.pem --config uav.yaml",
                           "rabit keys sign laptop.request.pem --tool"});
    command->add_option("REQUEST", sign->Requests, "Files that `rabit keys request` made")->required();
    AddFolder(*command, *sign);
    AddAccess(*command, *sign);
    AddPassphrase(*command, *sign);

    AddKeysCheckCommand(*keys, chosen);

    auto renew = AddCommand(*keys, "renew", "Makes new ones in place of those that nodes have", &Renew,
                            chosen, command, &CheckRequest);
    AddExamples(*command, {"rabit keys renew uav1 uav2 --days 30",
                           "rabit keys renew uav1 --config uav1.yaml --revoke-old",
                           "rabit keys renew uav1 --request uav1.request.pem"});
    command->add_option("NODE", renew->Nodes, "Names of the nodes")->required();
    AddFolder(*command, *renew);
    command->add_option("--config", renew->Config, "The node's configuration, if it has changed")
        ->check(CLI::ExistingFile);
    command->add_flag("--revoke-old", renew->RevokeOld,
                      "Revokes the older ones; refused for a node that would keep its key");
    command
        ->add_option(
            "--request", renew->Requests,
            "A request of the node for another key; without it, a node that made a request keeps its key")
        ->expected(1);
    AddDays(*command, *renew);
    AddPassphrase(*command, *renew);

    auto revoke =
        AddCommand(*keys, "revoke", "A node is not to be believed any more", &Revoke, chosen, command);
    AddExamples(*command, {"rabit keys revoke uav3", "rabit keys revoke uav3 --keys fleet_keys",
                           "rabit keys revoke uav3 --json"});
    command->add_option("NODE", revoke->Node, "Name of the node")->required();
    AddFolder(*command, *revoke);
    AddPassphrase(*command, *revoke);
}

}  // namespace Rabit::Tool
