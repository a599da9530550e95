// rabit keys: makes the keys, certificates and permissions of a fleet.
#include <rabit/transport/TransportFactory.h>

#include <algorithm>
#include <ctime>
#include <map>
#include <memory>
#include <optional>

#include "Command.h"
#include "KeysDomains.h"
#include "KeysOptions.h"
#include "SafeText.h"
#include "SealedKeys.h"
#include "keys/FleetKeys.h"
#include "keys/KeyFiles.h"
#include "keys/KeysCheck.h"
#include "keys/KeysError.h"
#include "keys/Passphrase.h"
#include "keys/SigningRequest.h"
#include "keys/SubjectName.h"
#include "manager/NodeSecurity.h"

namespace Rabit::Tool
{
namespace KeysParts
{
namespace
{

using Options = KeysOptions;

Keys::FleetKeys FleetOf(const Options &options)
{
    return Keys::FleetKeys(options.Folder, Keys::PassphraseFrom(options.PassphraseFile));
}

Keys::FleetKeys::Period PeriodOf(const Options &options)
{
    return {std::time(nullptr), options.Days};
}

Keys::FleetKeys::Request RequestFrom(const GatewayConfig &config)
{
    return {
        .Node = config.Node, .SmallGuid = Keys::WantsSmallGuid(config.Transport), .Access = AccessOf(config)};
}

Keys::FleetKeys::Request RequestOf(const Options &options, const Keys::FleetKeys &fleet,
                                   const std::string &node)
{
    GatewayConfig config;
    if (!options.Config.empty())
    {
        config = ConfigForKeys(options.Config, node);
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
    if (options.Sealed)
    {
        return SealedKeys::Init(options);
    }
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
    Output::ObjectOrLine(options.Json,
                         Json{{"folder", options.Folder},
                              {"fleet", fleet.Fleet()},
                              {"until", until},
                              {"encrypted", passphrase.has_value()}},
                         options.Folder + ": fleet `" + fleet.Fleet() + "`, valid until " + until +
                             (passphrase ? ", private keys of the authorities encrypted" : ""));
    Output::Talk("keep " + options.Folder +
                 "/authority where no node and no network reaches it: who has it can make keys for anybody");
    return Good;
}

int Add(const Options &options)
{
    if (SealedKeys::AreIn(options.Folder))
    {
        return SealedKeys::Add(options);
    }
    const Keys::FleetKeys fleet = FleetOf(options);
    fleet.Add(RequestOf(options, fleet, options.Node), PeriodOf(options));
    ShowMade(options, fleet, options.Node);
    return Good;
}

int Request(const Options &options)
{
    if (options.Sealed || SealedKeys::AreIn(options.Folder))
    {
        return SealedKeys::Request(options);
    }
    const Keys::RequestedKeys made = Keys::RequestKeys(options.Folder, options.Node);
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
    if (SealedKeys::AreIn(options.Folder))
    {
        return SealedKeys::Sign(options);
    }
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
    if (SealedKeys::AreIn(options.Folder))
    {
        return SealedKeys::Renew(options);
    }
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
            access.SmallGuid = Keys::WantsSmallGuid(options.Transport);
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
    if (SealedKeys::AreIn(options.Folder))
    {
        return SealedKeys::Revoke(options);
    }
    const Keys::FleetKeys fleet = FleetOf(options);
    const std::size_t count = fleet.Revoke(options.Node, std::time(nullptr));
    Output::ObjectOrLine(options.Json, Json{{"node", options.Node}, {"revoked", count}},
                         options.Node + ": " + std::to_string(count) +
                             (count == 1 ? " certificate is revoked" : " certificates are revoked"));
    Output::Talk("the folder " + fleet.FolderOf(options.Node) + " is removed");
    Output::Talk("each node believes " + options.Node +
                 " until it has its new revoked.pem and is started again; copy to each node:");
    for (const std::string &node : fleet.Nodes())
    {
        Output::Talk("    " + fleet.FolderOf(node) + "/revoked.pem");
    }
    return Good;
}

CLI::Option *AddFolder(CLI::App &command, Options &options)
{
    return command.add_option("--keys", options.Folder, "The fleet's folder")->capture_default_str();
}

CLI::Option *AddDays(CLI::App &command, Options &options, int days)
{
    constexpr int longest = 36500;
    options.Days = days;
    return command.add_option("--days", options.Days, "How long they are valid")
        ->check(CLI::Range(1, longest))
        ->capture_default_str();
}

CLI::Option *AddSealed(CLI::App &command, Options &options)
{
    return command.add_flag("--sealed", options.Sealed,
                            "Keys of the new format, with which each datagram is sealed");
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

    auto init = AddCommand(*keys, "init", "Makes the two authorities of a new fleet", &Init, chosen, command);
    AddExamples(*command, {"rabit keys init", "rabit keys init --sealed --passphrase",
                           "rabit keys init fleet_keys --name survey --days 365"});
    command->add_option("FOLDER", init->Folder, "Where to")->capture_default_str();
    CLI::Option *name =
        command->add_option("--name", init->FleetName, "Name of the fleet")->capture_default_str();
    CLI::Option *days = AddDays(*command, *init, 3650);
    // An authority of the new format has neither.
    AddSealed(*command, *init)->excludes(name)->excludes(days);
    command->add_flag("--passphrase", init->AsksForPassphrase,
                      "Asks at the terminal for a passphrase, and encrypts the authorities' private keys");
    command->add_option(
        "--passphrase-file", init->PassphraseFile,
        "Encrypts them with the first line of this file, or of /dev/fd/3 for a pipe; default: "
        "RABIT_KEYS_PASSPHRASE of the environment, if it is set");

    auto add = AddCommand(*keys, "add", "Makes a node's key, certificate and permissions", &Add, chosen,
                          command, &CheckAccess);
    AddExamples(*command,
                {"rabit keys add uav1 --config uav1.yaml", "rabit keys add laptop --tool --domain 7",
                 "rabit keys add uav1 --config uav1.yaml --days 30"});
    command->add_option("NODE", add->Node, "Name of the node")->required();
    AddFolder(*command, *add);
    AddAccess(*command, *add);
    AddPassphrase(*command, *add);

    auto request = AddCommand(*keys, "request",
                              "On a node: makes its private key, which stays there, and a request for a "
                              "certificate",
                              &Request, chosen, command);
    AddExamples(*command, {"rabit keys request uav1", "rabit keys request uav1 --to /etc/rabit/keys",
                           "rabit keys request uav1 --json"});
    command->add_option("NODE", request->Node, "Name of the node")->required();
    command->add_option("--to", request->Folder, "The node's folder of keys, made if it is not there")
        ->capture_default_str();
    AddSealed(*command, *request);

    auto sign = AddCommand(*keys, "sign",
                           "Makes certificates and permissions for nodes that made requests: no secret files",
                           &Sign, chosen, command, &CheckAccess);
    AddExamples(*command, {"rabit keys sign uav1.request.pem --config uav1.yaml",
                           "rabit keys sign uav1.request.pem uav2.request.pem --config uav.yaml",
                           "rabit keys sign laptop.request.pem --tool --domain 7"});
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
    command->add_option("--transport", renew->Transport, "DDS implementation, if it has changed");
    command->add_flag("--revoke-old", renew->RevokeOld,
                      "Revokes the older ones; refused for a node that would keep its key");
    command
        ->add_option(
            "--request", renew->Requests,
            "A request of the node for another key; without it, a node that made a request keeps its key")
        ->expected(1);
    AddDays(*command, *renew, 365);
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
