#pragma once

#include "Names.h"
#include "uav.idl.h"

#include <rabit/gateway/FleetValues.h>

#include <map>
#include <string>
#include <utility>

namespace Swarm
{

// The other aircraft: all whose Pose is in this workspace, posted by managers of this process or mirrored
// by the gateway. Only for the manager's thread.
class OtherAircraft
{
public:
    // An aircraft whose pose is older than this counts as absent.
    static constexpr double MaxAgeS = 3;

    // The manager must outlive this object.
    OtherAircraft(Names names, Rabit::RabitManager &manager)
        : _names(std::move(names)), _poses(manager, "Pose"), _findings(manager, "Findings")
    {
    }

    // The poses of the aircraft that are present now, by name.
    std::map<std::string, Uav::Pose> Poses()
    {
        _poses.Fetch();
        return Others<Uav::Pose>(_poses.YoungerThan(MaxAgeS));
    }
    // The findings of all aircraft that were ever present.
    std::map<std::string, Uav::Findings> Findings()
    {
        _findings.Fetch();
        return Others<Uav::Findings>(_findings.All());
    }

private:
    template <typename T>
    std::map<std::string, T> Others(const std::map<std::string, const T *> &all) const
    {
        std::map<std::string, T> others;
        for (const auto &[name, value] : all)
            if (name != _names.Aircraft())
                others.emplace(name, *value);
        return others;
    }

    const Names _names;
    Rabit::FleetValues<Uav::Pose> _poses;
    Rabit::FleetValues<Uav::Findings> _findings;
};

}  // namespace Swarm
