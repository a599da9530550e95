// rabit messages: all messages that nodes publish.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "Command.h"
#include "FleetSession.h"
#include "ForeignTopics.h"
#include "Meter.h"
#include "Offers.h"
#include "SafeText.h"
#include "Samples.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace MessagesParts
{
namespace
{

struct Options
{
    CommonOptions Common;
    double For = 0.0;
    bool Foreign = false;
};

// Returns the values a second of each message, the sum over its publishers, measured for `seconds`.
// Publishers from which fewer than two values came do not count.
std::map<std::string, double> RatesOf(const std::vector<Offers::Message> &messages, double seconds,
                                      FleetSession &session, Wakeup &wakeup)
{
    constexpr double look = 0.1;
    std::map<std::string, std::unique_ptr<Samples>> all;
    for (const Offers::Message &message : messages)
    {
        auto samples = std::make_unique<Samples>(session, message.Name);
        if (all.count(message.Name) == 0 && samples->Open(session.Seconds()) == Good)
        {
            all[message.Name] = std::move(samples);
        }
    }
    std::map<std::string, std::map<std::string, Meter>> meters;
    const double end = session.Seconds() + seconds;
    while (!wakeup.IsInterrupted() && session.Seconds() < end)
    {
        session.WaitUntil(std::min(end, session.Seconds() + look));
        for (const auto &[name, samples] : all)
        {
            for (const Sample &sample : samples->Take(session.Seconds()))
            {
                meters[name][sample.Node].Add(sample.At, sample.Bytes.size(), sample.Age);
            }
        }
    }
    std::map<std::string, double> rates;
    for (const auto &[name, nodes] : meters)
    {
        for (const auto &[node, meter] : nodes)
        {
            if (std::isfinite(meter.Rate()))
            {
                rates[name] += meter.Rate();
            }
        }
    }
    return rates;
}

double RateOf(const Offers::Message &message, const std::map<std::string, double> &rates)
{
    const auto found = rates.find(message.Name);
    return found == rates.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

using Subscribers = std::map<std::string, FleetExplorer::Subscribers>;

Subscribers SubscribersOf(const std::vector<Offers::Message> &messages, FleetSession &session)
{
    std::vector<std::string> names;
    for (const Offers::Message &message : messages)
    {
        names.push_back(message.Name);
    }
    return session.SubscribersOf(names);
}

std::string TextOf(const FleetExplorer::Subscribers &subscribers)
{
    if (subscribers.Others == 0)
    {
        return NamesText(subscribers.Nodes);
    }
    return (subscribers.Nodes.empty() ? "" : NamesText(subscribers.Nodes) + " ") + "+" +
           std::to_string(subscribers.Others) + " no node";
}

int Run(const Options &all, Wakeup &wakeup)
{
    const CommonOptions &options = all.Common;
    FleetSession session(ConfigOf(options), options, wakeup);
    // DDS programs without a gateway, which may read a message, are found by discovery alone. The nodes do
    // not know how many there are.
    session.WaitUntil(std::min(Offers::SecondsToHearEverybody({}), options.Wait));
    session.WaitForEverybody([&session] { return Offers::AreComplete(session.Nodes()); });
    if (wakeup.IsInterrupted())
    {
        return Interrupted;
    }
    if (!session.IsAnybodyThere())
    {
        return session.NobodyThere();
    }
    const std::vector<FleetSession::Node> nodes = session.Nodes();
    const std::vector<Offers::Message> messages = Offers::MessagesOf(nodes);
    // Looks at the subscribers before this program subscribes itself.
    Subscribers subscribers = SubscribersOf(messages, session);
    const auto rates =
        all.For > 0.0 ? RatesOf(messages, all.For, session, wakeup) : std::map<std::string, double>();
    std::vector<std::vector<std::string>> rows{{"MESSAGE", "TYPE", "QOS"}};
    if (all.For > 0.0)
    {
        rows[0].emplace_back("RATE");
    }
    rows[0].insert(rows[0].end(), {"PUBLISHED BY", "READ BY"});
    for (const Offers::Message &message : messages)
    {
        if (options.Json)
        {
            if (!Output::Object(Json{{"message", message.Name},
                                     {"type", message.Type},
                                     {"qos", message.Qos},
                                     {"definition", Offers::HashText(message.Definition)},
                                     {"publishers", message.Publishers},
                                     {"subscribers", subscribers[message.Name].Nodes},
                                     {"other_subscribers", subscribers[message.Name].Others},
                                     {"rate_hz", RateOf(message, rates)}}))
            {
                return Good;
            }
            continue;
        }
        rows.push_back({message.Name, SafeText(message.Type), message.Qos});
        if (all.For > 0.0)
        {
            rows.back().push_back(NumberText(RateOf(message, rates), 2, " Hz"));
        }
        rows.back().push_back(NamesText(message.Publishers));
        rows.back().push_back(TextOf(subscribers[message.Name]));
    }
    if (!options.Json && !Output::Lines(TableLines(rows)))
    {
        return Good;
    }
    if (all.Foreign && !ShowForeignTopics(session, options))
    {
        return Good;
    }
    const std::vector<std::string> differences = Offers::Differences(nodes);
    Output::Talk(differences);
    if (!Offers::AreComplete(nodes))
    {
        Output::Talk("not all nodes have announced themselves yet; ask again in 2 s");
    }
    return differences.empty() && Offers::AreComplete(nodes) ? Good : ProblemFound;
}

}  // namespace
}  // namespace MessagesParts

void AddMessagesCommand(CLI::App &app, Chosen &chosen)
{
    using namespace MessagesParts;
    const auto [command, options] = AddCommand<Options>(
        app, chosen, "messages", "All messages, their types, who publishes and who reads them", &Run);
    AddCommonOptions(*command, options->Common, 1.8);
    command
        ->add_option("--for", options->For,
                     "Listen to all of them for so many seconds, and tell how often they come")
        ->check(CLI::Range(0.1, 86400.0));
    command->add_flag("--foreign", options->Foreign,
                      "Also the topics of programs without a gateway, as of ROS 2, that nodes read or write");
    AddExamples(*command, {"rabit messages --domain 7", "rabit messages --for 3", "rabit messages --json"});
}

}  // namespace Rabit::Tool
