#include "OtherAircraft.h"

#include <string_view>
#include <typeinfo>
#include <utility>

namespace Swarm
{

OtherAircraft::OtherAircraft(Names names, Rabit::RabitWorkspace &workspace)
    : _names(std::move(names)), _workspace(workspace)
{
}

std::map<std::string, Uav::Pose> OtherAircraft::Poses()
{
    if (_looks.Due(_workspace.GetClock().Monotonic()))
        Look();
    std::map<std::string, Uav::Pose> fresh;
    for (const auto &[name, pose] : _poses)
    {
        pose->FetchMessage();
        if (pose->WasPosted() && pose->GetAgeSeconds() <= MaxAgeS)
            fresh.emplace(name, *pose);
    }
    return fresh;
}

std::map<std::string, Uav::Findings> OtherAircraft::Findings()
{
    std::map<std::string, Uav::Findings> known;
    for (const auto &[name, pose] : _poses)
    {
        std::shared_ptr<Uav::Findings> &findings = _findings[name];
        if (!findings)
        {
            findings = std::make_shared<Uav::Findings>();
            _workspace.AddPublishSubscribeMessage(_names.Of(name, "Findings"), findings);
        }
        if (findings->GetGlobalPublishSubscribeMessageRef())
            findings->FetchMessage();
        known.emplace(name, *findings);
    }
    return known;
}

void OtherAircraft::Look()
{
    constexpr std::string_view ending = "/Pose";
    for (const Rabit::MessageInfo &info : _workspace.GetListOfMessages())
    {
        if (info.Type != typeid(Uav::Pose) || !info.Name.ends_with(ending))
            continue;
        const std::string name = info.Name.substr(0, info.Name.size() - ending.size());
        if (name == _names.Aircraft() || _poses.contains(name))
            continue;
        auto pose = std::make_shared<Uav::Pose>();
        if (_workspace.AddPublishSubscribeMessage(info.Name, pose))
            _poses.emplace(name, std::move(pose));
    }
}

}  // namespace Swarm
