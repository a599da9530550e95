// rabit post: posts a message as a node of that name.
#include <rabit/base/ListedNames.h>
#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/QosProfileWords.h>
#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <memory>

#include "Command.h"
#include "FleetSession.h"
#include "FleetType.h"
#include "IdlFiles.h"
#include "Offers.h"

namespace Rabit::Tool
{
namespace PostParts
{
namespace
{

struct Options
{
    CommonOptions Common;
    std::string What;
    std::string Type;
    std::string Value;
    std::string Idl;
    std::string Qos = WordOf(QosProfile::State);
    double Rate = 0.0;
    double For = 0.0;
};

// The type; or null, and the exit code after the reason was reported.
struct Had
{
    std::shared_ptr<const DynamicType> Type;
    int Code = Good;
};

Had FromFile(const Options &options)
{
    const ParsedType parsed = IdlFiles({options.Idl}).Find(options.Type);
    if (!parsed.Type)
    {
        Output::Talk(parsed.Reason);
    }
    return {parsed.Type, parsed.Type ? Good : Usage};
}

// Also makes sure that no node has the name.
Had FromFleet(const Options &options, const std::string &node, Wakeup &wakeup)
{
    FleetSession session(ConfigOf(options.Common), options.Common, wakeup);
    const auto definitions = [&]
    {
        const auto types = Offers::TypesOf(session.Nodes());
        const auto found = types.find(options.Type);
        return found == types.end() ? Offers::Definitions() : found->second;
    };
    // Two nodes of one name disturb each other, so this listens for a node of that name for --wait seconds,
    // even if the fleet is known earlier: a silent node that the others hold for LOST is not in their sums.
    if (session.WaitUntil(options.Common.Wait, [&] { return !session.TakenOf({node}).empty(); }))
    {
        Output::Talk(NameIsTaken(node));
        return {nullptr, ProblemFound};
    }
    if (!options.Idl.empty())
    {
        return FromFile(options);
    }
    if (!session.IsAnybodyThere())
    {
        return {nullptr, session.NobodyThere()};
    }
    const Offers::Definitions found = definitions();
    if (found.size() != 1)
    {
        std::vector<std::string> names;
        for (const auto &[type, holders] : Offers::TypesOf(session.Nodes()))
        {
            names.push_back(type);
        }
        Output::Talk(found.empty()
                         ? "nobody announces a type `" + options.Type + "`" +
                               NearestWordHint(options.Type, names) + " (--idl FILE names a text of it)"
                         : "nodes were built with different definitions of `" + options.Type +
                               "` (--idl FILE says which is meant)");
        return {nullptr, ProblemFound};
    }
    const auto &[definition, holders] = *found.begin();
    const FleetType type = FetchType(session, {holders.begin(), holders.end()}, options.Type, definition,
                                     session.Seconds() + options.Common.Wait);
    if (!type.Type)
    {
        Output::Talk(type.Reason);
    }
    return {type.Type, type.Type ? Good : ProblemFound};
}

// The types, other than that of the post, in which others read the message.
std::vector<std::string> OtherTypes(const std::string &name, const std::string &type, FleetSession &session)
{
    std::vector<std::string> types = session.SubscribersOf({name})[name].Types;
    std::erase(types, type);
    return types;
}

int Post(const Options &options, const std::string &node, const std::string &name, DynamicMessage &message,
         Wakeup &wakeup)
{
    GatewayConfig config = ConfigOf(options.Common);
    config.Tool.reset();
    config.Node = node;
    PublishRule rule;
    rule.Message = name;
    rule.Type = options.Type;
    rule.Qos = ProfileOf(options.Qos).value_or(QosProfile::State);
    config.Publish.push_back(rule);
    FleetSession session(config, options.Common, wakeup);
    auto posted = std::make_shared<DynamicMessage>(message);
    if (!session.Workspace().AddPublishSubscribeMessage(name, posted))
    {
        Output::Talk("`" + name + "` is a message of this program's own");
        return Usage;
    }
    const auto status = [&session]
    {
        const auto publications = session.Fleet().publications;
        return publications.empty() ? Gateway::PublicationStatus() : publications.front();
    };
    const auto isRead = [&status] { return status().readers > 0; };
    // Waits for a reader before the first post: a single value reaches only nodes that have heard this node.
    session.WaitUntil(options.Common.Wait, isRead);
    const double begin = session.Seconds();
    const double end = options.For > 0.0    ? begin + options.For
                       : options.Rate > 0.0 ? FleetSession::Forever
                                            : begin + 2.0;
    std::uint64_t posts = 0;
    while (!wakeup.IsInterrupted() && (posts == 0 || session.Seconds() < end))
    {
        posted->PostMessage();
        ++posts;
        const double next = options.Rate > 0.0 ? begin + static_cast<double>(posts) / options.Rate : end;
        if (session.WaitUntil(std::min(next, end), [&session] { return session.IsTwice(); }))
        {
            Output::Talk(NameIsTaken(node));
            return ProblemFound;
        }
    }
    const bool anybody = isRead();
    const std::uint32_t readers = status().readers;
    Output::ObjectOrLine(options.Common.Json,
                         {{"node", node}, {"message", name}, {"posts", posts}, {"readers", readers}},
                         std::to_string(posts) + (posts == 1 ? " post, " : " posts, ") +
                             std::to_string(readers) + (readers == 1 ? " reader" : " readers"));
    if (!anybody)
    {
        const auto types = OtherTypes(name, options.Type, session);
        Output::Talk(types.empty() ? "nobody subscribes to `" + name + "`, or nobody from `" + node + "`"
                                   : "subscribers of `" + name + "` want " + ListedNames(types) + ", not `" +
                                         options.Type + "`");
    }
    return anybody ? Good : ProblemFound;
}

int Run(const Options &options, Wakeup &wakeup)
{
    const std::size_t slash = options.What.find('/');
    const std::string node = options.What.substr(0, slash);
    const std::string name = slash == std::string::npos ? "" : options.What.substr(slash + 1);
    if (!IsNodeName(node) || !IsMessageName(name) || name.find('/') != std::string::npos)
    {
        Output::Talk("`" + options.What + "` is no message of a node; expected NODE/MESSAGE, as sim1/Pose");
        return Usage;
    }
    const Had had = FromFleet(options, node, wakeup);
    if (!had.Type)
    {
        return had.Code;
    }
    DynamicMessage message(had.Type);
    if (const std::string misfit = message.SetJson(options.Value); !misfit.empty())
    {
        Output::Talk(misfit);
        return ProblemFound;
    }
    if (DynamicType::Register(had.Type) == nullptr)
    {
        Output::Talk("this program has another definition of `" + options.Type + "`");
        return ProblemFound;
    }
    return wakeup.IsInterrupted() ? Good : Post(options, node, name, message, wakeup);
}

}  // namespace
}  // namespace PostParts

void AddPostCommand(CLI::App &app, Chosen &chosen)
{
    using namespace PostParts;
    const auto [command, options] = AddCommand<Options>(
        app, chosen, "post", "Posts a message as a node of that name, once or at a rate", &Run);
    command->add_option("MESSAGE", options->What, "As sim1/Pose: node sim1 posts its Pose")->required();
    command->add_option("TYPE", options->Type, "As Uav::Pose")->required();
    command->add_option("JSON", options->Value, "The value; what it leaves out has its default")->required();
    AddCommonOptions(*command, options->Common, 3.0);
    command->add_option("--qos", options->Qos, "state or telemetry")
        ->check(CLI::IsMember(QosProfileWords))
        ->capture_default_str();
    command->add_option("--rate", options->Rate, "Posts a second, until Ctrl-C; without it one")
        ->check(CLI::Range(0.001, 1000.0));
    command
        ->add_option("--for", options->For, "Seconds after which the node leaves (default: 2 with one post)")
        ->check(CLI::Range(0.1, 86400.0));
    command->add_option("--idl", options->Idl, "A file with the type's IDL, in place of asking for it");
    AddExamples(*command, {R"(rabit post sim1/Pose Uav::Pose '{"altitude_m": 500}')",
                           "rabit post sim1/Pose Uav::Pose '{}' --rate 10 --qos telemetry",
                           "rabit post sim1/Pose Uav::Pose '{}' --idl uav.idl --for 10"});
}

}  // namespace Rabit::Tool
