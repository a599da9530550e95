#pragma once

#include <gtest/gtest.h>
#include <rabit/testing/SimulatedFleet.h>

#include <string>

#include "uav.idl.h"

namespace Rabit
{

// An aircraft: publishes Pose (telemetry) and MissionState (state), accepts Goto and TargetReport.
inline GatewayConfig AircraftConfig(const std::string &node)
{
    GatewayConfig config;
    config.Node = node;
    config.Publish.push_back({.Message = "Pose", .Type = "Uav::Pose", .Qos = QosProfile::Telemetry});
    config.Publish.push_back({.Message = "MissionState", .Type = "Uav::MissionState"});
    config.Accept.push_back({.Queue = "MissionControl", .Types = {"Uav::Goto", "Uav::TargetReport"}});
    return config;
}

// A ground station: wants both messages of every aircraft, accepts acknowledgements.
inline GatewayConfig GroundConfig()
{
    GatewayConfig config;
    config.Node = "ground";
    config.Subscribe.push_back({.Message = "Pose", .Type = "Uav::Pose", .From = {"uav*"}});
    config.Subscribe.push_back({.Message = "MissionState", .Type = "Uav::MissionState", .From = {"uav*"}});
    config.Accept.push_back({.Queue = "Commands", .Types = {"Uav::CommandAck"}});
    return config;
}

}  // namespace Rabit
