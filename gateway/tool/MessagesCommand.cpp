// rabit messages: all that is published.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

#include "Command.h"
#include "CommonOptions.h"
#include "FleetSession.h"
#include "Offers.h"
#include "Output.h"
#include "SafeText.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace
{

using Json = nlohmann::ordered_json;

int Run(const CommonOptions &options, Wakeup &wakeup)
{
    constexpr double everybody = 1.5;
    FleetSession session(ConfigOf(options), options, wakeup);
    session.WaitUntil(std::min(everybody, options.Wait), [] { return false; });
    session.WaitUntil(options.Wait, [&session]
                      { return session.IsAnybodyThere() && Offers::AreComplete(session.Nodes()); });
    if (!session.IsAnybodyThere())
    {
        return session.NobodyThere();
    }
    const std::vector<FleetSession::Node> nodes = session.Nodes();
    std::vector<std::vector<std::string>> rows{{"MESSAGE", "TYPE", "QOS", "PUBLISHED BY"}};
    for (const Offers::Message &message : Offers::MessagesOf(nodes))
    {
        if (options.Json)
        {
            if (!Output::Object(Json{{"message", message.Name},
                                     {"type", message.Type},
                                     {"qos", message.Qos},
                                     {"definition", Offers::HashText(message.Definition)},
                                     {"publishers", message.Publishers}}))
            {
                return Good;
            }
            continue;
        }
        std::string publishers;
        for (const std::string &node : message.Publishers)
        {
            publishers += (publishers.empty() ? "" : " ") + node;
        }
        rows.push_back({message.Name, SafeText(message.Type), message.Qos, publishers});
    }
    if (!options.Json)
    {
        for (const std::string &line : TableLines(rows))
        {
            if (!Output::Line(line))
            {
                return Good;
            }
        }
    }
    const std::vector<std::string> differences = Offers::Differences(nodes);
    for (const std::string &line : differences)
    {
        Output::Talk(line);
    }
    if (!Offers::AreComplete(nodes))
    {
        Output::Talk("not all nodes have announced themselves yet; --wait waits longer");
    }
    return differences.empty() && Offers::AreComplete(nodes) ? Good : ProblemFound;
}

}  // namespace

void AddMessagesCommand(CLI::App &app, Chosen &chosen)
{
    auto options = std::make_shared<CommonOptions>();
    CLI::App *command = app.add_subcommand("messages", "All messages, their types, and who publishes them");
    AddCommonOptions(*command, *options, 1.8);
    command->callback([options, &chosen]
                      { chosen.Run = [options](Wakeup &wakeup) { return Run(*options, wakeup); }; });
}

}  // namespace Rabit::Tool
