// rabit type: the IDL of a type.
#include <algorithm>

#include <rabit/idl/NearestWord.h>
#include "Command.h"
#include "FleetSession.h"
#include "FleetType.h"
#include "Offers.h"
#include "SafeText.h"

namespace Rabit::Tool
{
namespace TypeParts
{
namespace
{

struct Options
{
    CommonOptions Common;
    std::string Name;
};

// Returns the type of that name, or the type of the message of that name.
std::string TypeNamed(const std::string &name, const std::vector<FleetSession::Node> &nodes)
{
    const std::string message = name.substr(name.find('/') == std::string::npos ? 0 : name.find('/') + 1);
    for (const Offers::Message &published : Offers::MessagesOf(nodes))
    {
        if (published.Name == message)
        {
            return published.Type;
        }
    }
    return name;
}

std::vector<std::string> NamesIn(const std::vector<FleetSession::Node> &nodes)
{
    std::vector<std::string> names;
    for (const auto &[type, definitions] : Offers::TypesOf(nodes))
    {
        names.push_back(type);
    }
    for (const Offers::Message &message : Offers::MessagesOf(nodes))
    {
        names.push_back(message.Name);
    }
    return names;
}

// Returns the hint at the nearest word. A type may be named without its modules.
std::string HintFor(const std::string &name, const std::vector<std::string> &names)
{
    const auto whole = std::find_if(names.begin(), names.end(),
                                    [&name](const std::string &one) { return one.ends_with("::" + name); });
    return whole != names.end() ? "; did you mean `" + *whole + "`?" : NearestWordHint(name, names);
}

int Run(const Options &options, Wakeup &wakeup)
{
    FleetSession session(ConfigOf(options.Common), options.Common, wakeup);
    const auto definitions = [&]
    {
        const auto nodes = session.Nodes();
        const auto types = Offers::TypesOf(nodes);
        const auto found = types.find(TypeNamed(options.Name, nodes));
        return found == types.end() ? Offers::Definitions() : found->second;
    };
    session.WaitForOffers("*", [&] { return !definitions().empty(); });
    const auto nodes = session.Nodes();
    if (nodes.empty())
    {
        return session.NobodyThere();
    }
    const Offers::Definitions found = definitions();
    if (found.empty())
    {
        Output::Talk("nobody announces a type or message `" + options.Name + "`" +
                     HintFor(options.Name, NamesIn(nodes)));
        return ProblemFound;
    }
    const std::string name = TypeNamed(options.Name, nodes);
    bool good = found.size() == 1;
    for (const auto &[definition, holders] : found)
    {
        const FleetType type = FetchType(session, {holders.begin(), holders.end()}, name, definition,
                                         session.Seconds() + options.Common.Wait);
        if (type.Text.empty())
        {
            Output::Talk(type.Reason);
            good = false;
            continue;
        }
        const bool isRead =
            options.Common.Json
                ? Output::Object(Json{{"type", name},
                                      {"definition", Offers::HashText(definition)},
                                      {"nodes", holders},
                                      {"idl", type.Text}})
                : Output::Line(SafeLines(type.Text.substr(0, type.Text.find_last_not_of('\n') + 1)));
        if (!isRead)
        {
            return Good;
        }
    }
    Output::Talk(Offers::Differences(nodes));
    return good ? Good : ProblemFound;
}

}  // namespace
}  // namespace TypeParts

void AddTypeCommand(CLI::App &app, Chosen &chosen)
{
    using namespace TypeParts;
    const auto [command, options] =
        AddCommand<Options>(app, chosen, "type", "The IDL of a type, from a node that has it", &Run);
    command->add_option("NAME", options->Name, "Of a type, as Uav::Pose, or of a message, as Pose")
        ->required();
    AddCommonOptions(*command, options->Common, 3.0);
    AddExamples(*command,
                {"rabit type Uav::Pose", "rabit type uav1/Pose", "rabit type Pose --domain 7 --json"});
}

}  // namespace Rabit::Tool
