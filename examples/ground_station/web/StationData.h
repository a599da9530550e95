#pragma once

#include "FleetTable.h"
#include "FleetTargets.h"
#include "RadioWatch.h"
#include "ground.idl.h"
#include "uav.idl.h"

#include <rabit/gateway/Fleet.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace Ground
{

// A message with its age. The message must outlive this object.
template <typename Message>
struct Aged
{
    const Message *Content = nullptr;  // null: none has come
    double AgeS = 0;                   // since it was true at its origin

    explicit operator bool() const { return Content != nullptr; }
};

// Fetches the latest value of a registered message, with its age. Nothing if none has come, or if its name
// belongs to a message of another type, which the workspace has logged.
template <typename Message>
Aged<Message> Latest(Message &message)
{
    if (!message.GetGlobalPublishSubscribeMessageRef())
        return {};
    message.FetchMessage();
    if (!message.WasPosted())
        return {};
    return {&message, message.GetAgeSeconds()};
}

// The latest picture of one aircraft.
struct PictureData
{
    std::uint32_t Number = 0;
    double AgeS = 0;  // since it was taken, or since it came if that is not known
};

// The present data of one aircraft.
struct AircraftData
{
    static constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

    std::string Node;
    RowState State = RowState::Waiting;
    std::string Reason;       // why it is not UP
    double HeardS = Unknown;  // since it was last heard
    double RoundTripS = Unknown;
    std::string Path{};             // by which it is reached; empty: there is only one
    double DeliveryRate = Unknown;  // bytes a second of queue messages that arrive there
    Aged<Uav::Pose> Pose;           // the last one with a good position
    std::string BadPosition{};      // why the position of the newest pose is bad; empty if it is not
    Aged<Uav::MissionState> Mission;
    Aged<Uav::Health> Health;
    Aged<Uav::Findings> Findings;
    Aged<Uav::Targets> Targets;
    Aged<Uav::CameraView> Camera;
    std::optional<PictureData> Picture;
    bool WithoutOrders = false;  // see NodeCommands
    bool Replay = false;         // it plays a recording, or did when it was last heard
};

// The present data of the ground station.
struct StationData
{
    std::string Node;                                            // of the ground station
    std::string Life;                                            // different in each incarnation of the
                                                                 // program
    std::uint64_t Number = 0;                                    // counted from 1 in each incarnation
    double NowS = 0;                                             // by the clock of the ages
    double FleetAgeS = std::numeric_limits<double>::infinity();  // of the Fleet with the states of the
                                                                 // aircraft
    std::vector<AircraftData> Aircraft;
    Aged<AreaList> Areas;
    Aged<Uav::Geofence> Fence;
    Aged<CommandList> Commands;
    std::vector<Rabit::Gateway::Problem> Problems;
    std::vector<std::string> Replayed;  // present nodes that play a recording
    RadioUse Radio;                     // of this node, as old as the states of the aircraft
};

// The targets of all aircraft as one list.
inline std::vector<ListedTarget> TargetsOf(const StationData &data)
{
    std::vector<SaidOfTargets> said;
    for (const AircraftData &one : data.Aircraft)
        said.push_back({one.Node, one.Targets.Content, one.Targets.AgeS,
                        one.Findings ? &one.Findings.Content->items : nullptr});
    return ListTargets(said);
}

}  // namespace Ground
