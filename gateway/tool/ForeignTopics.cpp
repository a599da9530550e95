#include "ForeignTopics.h"

#include <rabit/base/ListedNames.h>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

#include "NodeAnswers.h"
#include "Output.h"
#include "SafeText.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace
{

nlohmann::ordered_json JsonOfForeign(const std::string &node, const Gateway::ForeignTopic &topic)
{
    return {{"foreign", topic.topic},   {"node", node},
            {"type", topic.type},       {"local", topic.local},
            {"written", topic.written}, {"state", ToString(topic.state)},
            {"reason", topic.reason},   {"qos", topic.qos},
            {"samples", topic.samples}, {"readers", topic.readers}};
}

}  // namespace

bool ShowForeignTopics(FleetSession &session, const CommonOptions &options)
{
    const NodeAnswers nodes = AnswersOfAll(session, FleetExplorer::Report::Foreign,
                                           session.Seconds() + (options.IsWaitGiven ? options.Wait : 2.0));
    std::vector<std::string> silent;
    std::vector<std::vector<std::string>> rows{
        {"FOREIGN TOPIC", "TYPE", "NODE", "LOCAL", "STATE", "SAMPLES", "REASON"}};
    bool good = true;
    for (const auto &[name, answer] : nodes)
    {
        if (!answer)
        {
            silent.push_back(name);
            continue;
        }
        for (const Gateway::ForeignTopic &topic : FleetExplorer::ForeignTopicsIn(*answer))
        {
            if (options.Json)
            {
                good = good && Output::Object(JsonOfForeign(name, topic));
            }
            // A topic that this node writes has no state.
            rows.push_back({SafeText(topic.topic), SafeText(topic.type), SafeText(name),
                            SafeText(topic.local), topic.written ? "written" : ToString(topic.state),
                            std::to_string(topic.samples),
                            topic.reason.empty() ? "-" : SafeText(topic.reason)});
        }
    }
    if (!options.Json && rows.size() > 1)
    {
        good = Output::Line("") && Output::Lines(TableLines(rows));
    }
    if (!silent.empty())
    {
        Output::Talk("no word of foreign topics from " + ListedNames(silent) +
                     ": ask again, or give a longer --wait");
    }
    return good;
}

bool ShowRosNodes(const RosNodes::Names &programs, bool json)
{
    std::vector<std::vector<std::string>> rows{{"ROS 2 PROGRAM", "NODES"}};
    bool good = true;
    for (const auto &[prefix, nodes] : programs)
    {
        if (json)
        {
            good = good && Output::Object({{"ros_program", prefix}, {"nodes", nodes}});
        }
        rows.push_back({SafeText(prefix), SafeText(NamesText(nodes))});
    }
    if (!json && rows.size() > 1)
    {
        good = Output::Line("") && Output::Lines(TableLines(rows));
    }
    return good;
}

}  // namespace Rabit::Tool
