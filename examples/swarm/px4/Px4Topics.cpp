#include "Px4Topics.h"

#include <algorithm>

namespace Swarm
{
namespace
{

using Rabit::ForeignRule;

constexpr const char *Prefix = "dds:/";

struct Topic
{
    ForeignRule::Direction Way;
    const char *Local;
    const char *Name;
    const char *Type;
};

constexpr Topic Topics[] = {{ForeignRule::Direction::Subscribe, "Px4/Status", "/fmu/out/vehicle_status",
                             "px4_msgs::msg::VehicleStatus"},
                            {ForeignRule::Direction::Subscribe, "Px4/Position",
                             "/fmu/out/vehicle_global_position", "px4_msgs::msg::VehicleGlobalPosition"},
                            {ForeignRule::Direction::Subscribe, "Px4/LocalPosition",
                             "/fmu/out/vehicle_local_position", "px4_msgs::msg::VehicleLocalPosition"},
                            {ForeignRule::Direction::Subscribe, "Px4/Attitude", "/fmu/out/vehicle_attitude",
                             "px4_msgs::msg::VehicleAttitude"},
                            {ForeignRule::Direction::Subscribe, "Px4/Ack", "/fmu/out/vehicle_command_ack",
                             "px4_msgs::msg::VehicleCommandAck"},
                            {ForeignRule::Direction::Publish, "Px4/Command", "/fmu/in/vehicle_command",
                             "px4_msgs::msg::VehicleCommand"}};

}  // namespace

std::string IsPx4(const std::string &text)
{
    const bool hasNamespace = text.rfind(Prefix, 0) == 0 && text.size() > std::string(Prefix).size();
    return text == "dds" || hasNamespace ? "" : "`" + text + "` is no PX4; expected dds or dds:/namespace";
}

std::string Px4Namespace(const std::string &text)
{
    return text.rfind(Prefix, 0) == 0 ? text.substr(std::string(Prefix).size() - 1) : "";
}

void AddPx4Topics(Rabit::GatewayConfig &config, const std::string &prefix)
{
    for (const Topic &topic : Topics)
    {
        const bool given =
            std::any_of(config.Foreign.begin(), config.Foreign.end(),
                        [&topic](const ForeignRule &rule) { return rule.Local == topic.Local; });
        if (given)
        {
            continue;
        }
        ForeignRule rule;
        rule.Way = topic.Way;
        rule.Topic = prefix + topic.Name;
        rule.Type = topic.Type;
        rule.Local = topic.Local;
        rule.Names = ForeignRule::WireNames::Ros2;
        // Only answers are rare; all other topics come many times a second.
        const bool isSteady = topic.Way == ForeignRule::Direction::Subscribe && rule.Local != "Px4/Ack";
        rule.StaleAfter = std::chrono::seconds(isSteady ? 3 : 0);
        config.Foreign.push_back(rule);
    }
}

}  // namespace Swarm
