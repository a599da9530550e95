// rabit complete -- WORD...: lists candidates for the last of the words, for the shells (completion/).
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/QosProfileWords.h>
#include <rabit/transport/TransportFactory.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "Command.h"
#include "FleetSession.h"
#include "Offers.h"

namespace Rabit::Tool
{
namespace
{

using Words = std::vector<std::string>;
using Candidates = std::set<std::string>;

// Tells the shell to offer its files.
constexpr const char *Files = ":files";

bool IsOption(const std::string &word)
{
    return word.size() > 1 && word.front() == '-';
}

// Null if the option takes no value.
const CLI::Option *OptionWithValue(const CLI::App &command, const std::string &word)
{
    const CLI::Option *option = IsOption(word) ? command.get_option_no_throw(word) : nullptr;
    return option != nullptr && option->get_items_expected_max() > 0 ? option : nullptr;
}

Candidates CommandsOf(const CLI::App &app)
{
    Candidates found;
    for (const CLI::App *command : app.get_subcommands({}))
    {
        found.insert(command->get_name());
    }
    return found;
}

Candidates OptionsOf(const CLI::App &command)
{
    Candidates found;
    for (const CLI::Option *option : command.get_options())
    {
        for (const std::string &name : option->get_lnames())
        {
            found.insert("--" + name);
        }
    }
    return found;
}

Candidates ValuesOf(const CLI::Option &option)
{
    const std::string &name = option.get_lnames().empty() ? option.get_name() : option.get_lnames().front();
    if (name == "transport")
    {
        const auto names = KnownTransports();
        return {names.begin(), names.end()};
    }
    if (name == "qos")
    {
        return {QosProfileWords.begin(), QosProfileWords.end()};
    }
    if (name == "config" || name == "idl" || name == "to" || name == "plot" || name == "keys" ||
        name == "passphrase-file" || name == "request")
    {
        return {Files};
    }
    Candidates found;
    if (name == "interface")
    {
        std::error_code failed;
        for (const auto &entry : std::filesystem::directory_iterator("/sys/class/net", failed))
        {
            found.insert(entry.path().filename().string());
        }
    }
    return found;
}

// Only these characters go to a shell: a type name comes from the network.
bool IsTypeName(const std::string &text)
{
    return std::all_of(text.begin(), text.end(),
                       [](char c)
                       {
                           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                  (c >= '0' && c <= '9') || c == '_' || c == ':';
                       });
}

// Returns the fleet's candidates for an argument, by the arguments before it.
Candidates ArgumentsIn(const std::vector<FleetSession::Node> &nodes, const std::string &command,
                       const Words &before)
{
    Candidates found;
    const auto addType = [&found](const std::string &type)
    {
        if (IsTypeName(type))
        {
            found.insert(type);
        }
    };
    const bool isListening = command == "echo" || command == "hz" || command == "bytes" || command == "age" ||
                             command == "record" || command == "foxglove";
    const bool isType = before.empty() && command == "type";
    for (const Offers::Message &message : Offers::MessagesOf(nodes))
    {
        if ((before.empty() && isListening) || isType)
        {
            for (const std::string &node : message.Publishers)
            {
                found.insert(node + "/" + message.Name);
            }
        }
        if (before.size() == 1 && command == "post")
        {
            addType(message.Type);
        }
    }
    if (isType)
    {
        for (const auto &[type, definitions] : Offers::TypesOf(nodes))
        {
            addType(type);
        }
    }
    if ((command == "log" || command == "ping") && before.empty())
    {
        for (const FleetSession::Node &node : nodes)
        {
            found.insert(node.Name);
        }
    }
    if (command == "fetch" && before.empty())
    {
        for (const FleetSession::Node &node : nodes)
        {
            found.insert(node.Name + ":");
        }
    }
    if (command != "send" || before.size() > 1)
    {
        return found;
    }
    for (const FleetSession::Node &node : nodes)
    {
        for (const auto &queue : node.Offers ? node.Offers->accepts : std::vector<Gateway::AcceptedQueue>())
        {
            const Candidates addresses{node.Name + "/" + queue.queue, "*/" + queue.queue};
            if (before.empty())
            {
                found.insert(addresses.begin(), addresses.end());
            }
            else if (addresses.contains(before.front()))
            {
                for (const auto &type : queue.types)
                {
                    addType(type.type);
                }
            }
        }
    }
    return found;
}

// Returns the network that the line names so far; empty if it names none that can be joined.
std::optional<GatewayConfig> NetworkOf(Words line, CommonOptions &options)
{
    CLI::App app;
    app.allow_extras();
    AddCommonOptions(app, options, 0.0);
    TakeOneValueEach(app);
    std::reverse(line.begin(), line.end());
    try
    {
        app.parse(line);
        options.Verbose = false;
        return ConfigOf(options);
    }
    catch (const CLI::ParseError &)
    {
        return std::nullopt;
    }
    catch (const ConfigError &)
    {
        return std::nullopt;
    }
}

// Listens until the whole fleet is known, for 0.8 s at most, then until every node has announced itself, 1.5
// s in all at most: a shell waits for it.
Candidates FromFleet(const Words &line, const std::string &command, const Words &before, Wakeup &wakeup)
{
    constexpr double everybody = 0.8;
    constexpr double longest = 1.5;
    CommonOptions options;
    const auto config = NetworkOf(line, options);
    if (!config)
    {
        return {};
    }
    FleetSession session(*config, options, wakeup);
    session.WaitUntil(everybody, [&session] { return session.IsFleetKnown(); });
    session.WaitUntil(
        longest, [&session] { return session.IsAnybodyThere() && Offers::AreComplete(session.Nodes()); });
    return ArgumentsIn(session.Nodes(), command, before);
}

// Returns all candidates for that place, even those that do not begin with `last`.
Candidates CandidatesFor(const CLI::App &app, const Words &before, const std::string &last, Wakeup &wakeup)
{
    const Candidates commands = CommandsOf(app);
    const auto named = std::find_if(before.begin(), before.end(),
                                    [&commands](const std::string &word) { return commands.contains(word); });
    if (named == before.end())
    {
        return IsOption(last) ? OptionsOf(app) : commands;
    }
    const CLI::App &command = *app.get_subcommand(*named);
    if (!CommandsOf(command).empty())
    {
        return CandidatesFor(command, Words(std::next(named), before.end()), last, wakeup);
    }
    Words arguments;
    const CLI::Option *open = nullptr;
    for (auto word = std::next(named); word != before.end(); ++word)
    {
        const bool isValue = open != nullptr;
        open = isValue ? nullptr : OptionWithValue(command, *word);
        if (!isValue && !IsOption(*word))
        {
            arguments.push_back(*word);
        }
    }
    if (open != nullptr)
    {
        // The option --to of `play` is a time; that of other commands is a file or folder.
        const bool isTime = command.get_name() == "play" && open->check_lname("to");
        return isTime ? Candidates() : ValuesOf(*open);
    }
    if (last.starts_with('-'))
    {
        return OptionsOf(command);
    }
    static const Candidates ofFiles = {"check", "info", "recover", "play", "merge",
                                       "knew",  "init", "sign",    "run",  "new"};
    if (ofFiles.contains(command.get_name()))
    {
        return {Files};
    }
    // Nodes that get keys need not be in the network yet.
    const bool isOfKeys = command.get_parent() != nullptr && command.get_parent()->get_parent() != nullptr;
    static const Candidates withoutArguments = {"claims", "doctor", "top"};
    if (withoutArguments.contains(command.get_name()) || isOfKeys)
    {
        return {};
    }
    return FromFleet(Words(std::next(named), before.end()), command.get_name(), arguments, wakeup);
}

}  // namespace

int Complete(const CLI::App &app, const Words &line, Wakeup &wakeup)
{
    const std::string last = line.empty() ? "" : line.back();
    const Words before(line.begin(), line.empty() ? line.end() : std::prev(line.end()));
    for (const std::string &candidate : CandidatesFor(app, before, last, wakeup))
    {
        if ((candidate == Files || candidate.starts_with(last)) && !Output::Line(candidate))
        {
            break;
        }
    }
    return Good;
}

}  // namespace Rabit::Tool
