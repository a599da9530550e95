#include "Snapshot.h"

#include "AreaLines.h"
#include "Limits.h"
#include "TargetName.h"
#include "WireNames.h"

#include <rabit/gateway/ClassRates.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace Ground
{
namespace
{
using Json = nlohmann::json;

// Rounds a number, to keep the text short. NaN and infinities become null.
Json Rounded(double value, double steps)
{
    const double scaled = value * steps;
    if (!std::isfinite(scaled))
        return nullptr;
    return std::round(scaled) / steps;
}
// Null also if it is out of range: no position on the earth has that number.
Json Degrees(double value, const Common::Range &range)
{
    return range.Contains(value) ? Rounded(value, 1e7) : Json(nullptr);
}
Json Latitude(double value)
{
    return Degrees(value, Common::LatitudeDeg);
}
Json Longitude(double value)
{
    return Degrees(value, Common::LongitudeDeg);
}
Json Short(double value)
{
    return Rounded(value, 1e3);
}

Json ToJson(const Uav::Pose &pose)
{
    return {{"latitude_deg", Latitude(pose.latitude_deg)},
            {"longitude_deg", Longitude(pose.longitude_deg)},
            {"altitude_m", Rounded(pose.altitude_m, 10)},
            {"speed_mps", Rounded(std::hypot(static_cast<double>(pose.velocity_north_mps),
                                             static_cast<double>(pose.velocity_east_mps)),
                                  10)},
            {"climb_mps", Rounded(-static_cast<double>(pose.velocity_down_mps), 10)},
            {"yaw_rad", Short(static_cast<double>(pose.yaw_rad))},
            {"number", pose.number}};
}

Json ToJson(const Uav::MissionState &mission)
{
    return {{"mode", WireName(mission.mode)},
            {"last_command", mission.last_command},
            {"search_area", mission.search_area},
            {"target", mission.target},
            {"partner", mission.partner},
            {"text", mission.text},
            {"area_declined", mission.area_declined}};
}

// Adds heights and home from the mission state; they stay valid however old that is.
void AddPlaces(Json &object, const Uav::MissionState &mission)
{
    object["floor_m"] = mission.has_floor ? Rounded(static_cast<double>(mission.floor_m), 10) : Json(nullptr);
    object["ground_m"] =
        mission.has_ground ? Rounded(static_cast<double>(mission.ground_m), 10) : Json(nullptr);
    object["home"] = mission.has_home ? Json{{"latitude_deg", Latitude(mission.home_latitude_deg)},
                                             {"longitude_deg", Longitude(mission.home_longitude_deg)}}
                                      : Json(nullptr);
}

Json ToJson(const Uav::Health &health)
{
    return {{"battery_percent", Rounded(static_cast<double>(health.battery_percent), 10)},
            {"ground_silent_s", Rounded(static_cast<double>(health.ground_silent_s), 10)},
            {"wants_home", health.wants_home},
            {"reason", health.reason}};
}

// Each target once. Place and ellipse come from the aircraft whose Targets are used, with their age. If no
// sensor fusion reports the target, they are the last that its finder knew.
Json ToJson(const ListedTarget &listed)
{
    Json item = {{"name", Common::TextOf(listed.Name)}, {"stage", "found"}, {"validated_by", ""}};
    Json formerly = Json::array();
    for (const Uav::TargetName &name : listed.Formerly)
        formerly.push_back(Common::TextOf(name));
    item["formerly"] = std::move(formerly);
    if (listed.Found)
    {
        const Uav::Finding &finding = listed.Found->Finding;
        item["node"] = listed.Found->Aircraft;
        item["stage"] = WireName(finding.stage);
        item["latitude_deg"] = Latitude(finding.latitude_deg);
        item["longitude_deg"] = Longitude(finding.longitude_deg);
        item["validated_by"] = finding.validated_by;
        item["tracked_s"] = Rounded(static_cast<double>(finding.tracked_s), 10);
        item["seen_by"] = Json::array({listed.Found->Aircraft});
    }
    if (!listed.Target)
        return item;
    const Uav::Target &target = *listed.Target;
    item["told_by"] = listed.ToldBy;
    item["age_s"] = Short(listed.AgeS);
    item["unseen_s"] = Rounded(listed.UnseenS, 10);
    item["found_by"] = target.found_by;
    item["latitude_deg"] = Latitude(target.latitude_deg);
    item["longitude_deg"] = Longitude(target.longitude_deg);
    item["velocity_north_mps"] = Rounded(static_cast<double>(target.velocity_north_mps), 100);
    item["velocity_east_mps"] = Rounded(static_cast<double>(target.velocity_east_mps), 100);
    item["sigma_major_m"] = Rounded(static_cast<double>(target.sigma_major_m), 10);
    item["sigma_minor_m"] = Rounded(static_cast<double>(target.sigma_minor_m), 10);
    item["sigma_heading_rad"] = Short(static_cast<double>(target.sigma_heading_rad));
    item["detections"] = target.detections;
    item["seen_by"] = target.seen_by;
    return item;
}

Json ToJson(const Uav::CameraView &view)
{
    Json corners = Json::array();
    for (const Uav::GroundPoint &corner : view.corners)
        corners.push_back({Latitude(corner.latitude_deg), Longitude(corner.longitude_deg)});
    return {{"frame", view.frame}, {"corners", std::move(corners)}};
}

Json ToJson(const Uav::SearchArea &area)
{
    return {{"number", area.number},
            {"latitude_deg", Latitude(area.latitude_deg)},
            {"longitude_deg", Longitude(area.longitude_deg)},
            {"north_m", Rounded(static_cast<double>(area.north_m), 10)},
            {"east_m", Rounded(static_cast<double>(area.east_m), 10)},
            {"altitude_m", Rounded(static_cast<double>(area.altitude_m), 10)},
            {"speed_mps", Rounded(static_cast<double>(area.speed_mps), 10)},
            {"lane_m", Rounded(static_cast<double>(area.lane_m), 10)}};
}

// With the outcome at each aircraft.
Json ToJson(const AreaStatus &area, double nowS)
{
    Json answers = Json::array();
    for (const AreaAnswer &answer : area.answers)
        answers.push_back({{"node", answer.node},
                           {"progress", WireName(answer.progress)},
                           {"reason", answer.reason},
                           {"flies", answer.flies}});
    Json object = ToJson(area.area);
    object["given_age_s"] = Short(nowS - area.given_s);
    object["flown_by"] = CountOf(area, AreaProgress::AREA_FLOWN);
    object["answers"] = std::move(answers);
    return object;
}

// Adds `areas`, the last ones with the wanted one at the end, and the numbers of that one as `area`.
void AddAreas(Json &snapshot, const Aged<AreaList> &list)
{
    Json areas = Json::array();
    if (list)
        for (const AreaStatus &area : list.Content->items)
            areas.push_back(ToJson(area, list.Content->posted_s + list.AgeS));
    snapshot["areas"] = std::move(areas);
    if (list && !list.Content->items.empty())
        snapshot["area"] = ToJson(list.Content->items.back().area);
}

Json ToJson(const Uav::Geofence &fence)
{
    return {{"latitude_deg", Latitude(fence.latitude_deg)},
            {"longitude_deg", Longitude(fence.longitude_deg)},
            {"radius_m", Rounded(fence.radius_m, 10)}};
}

template <typename Message>
void Add(Json &object, const char *name, const Aged<Message> &message)
{
    if (!message)
        return;
    Json part = ToJson(*message.Content);
    part["age_s"] = Short(message.AgeS);
    object[name] = std::move(part);
}

Json ToJson(const AircraftData &aircraft)
{
    Json object = {{"node", aircraft.Node},
                   {"state", WireName(aircraft.State)},
                   {"reason", aircraft.Reason},
                   {"heard_s", Short(aircraft.HeardS)},
                   {"round_trip_s", Rounded(aircraft.RoundTripS, 1e5)},
                   {"delivery_rate", Rounded(aircraft.DeliveryRate, 1)}};
    if (!aircraft.Path.empty())
        object["path"] = aircraft.Path;
    if (!aircraft.BadPosition.empty())
        object["bad_position"] = aircraft.BadPosition;
    if (aircraft.WithoutOrders)
        object["without_orders"] = true;
    if (aircraft.Replay)
        object["replay"] = true;
    if (aircraft.Mission)
        AddPlaces(object, *aircraft.Mission.Content);
    Add(object, "pose", aircraft.Pose);
    Add(object, "mission", aircraft.Mission);
    Add(object, "health", aircraft.Health);
    Add(object, "camera", aircraft.Camera);
    if (aircraft.Picture)
        object["picture"] = {{"number", aircraft.Picture->Number}, {"age_s", Short(aircraft.Picture->AgeS)}};
    return object;
}

// The list has times of its own clock, and is posted at each change. So its latest change has the time of
// its post.
Json ToJson(const CommandList &list, double ageS)
{
    double nowS = 0;
    for (const CommandStatus &command : list.items)
        nowS = std::max(nowS, command.changed_s);
    nowS += ageS;
    const auto listed = std::min(list.items.size(), CommandsInSnapshot);
    Json items = Json::array();
    for (auto command = std::prev(list.items.end(), static_cast<std::ptrdiff_t>(listed));
         command != list.items.end(); ++command)
    {
        Json item = {{"number", command->number},
                     {"node", command->node},
                     {"kind", WireName(command->kind)},
                     {"progress", WireName(command->progress)},
                     {"reason", command->reason},
                     {"sent_age_s", Short(nowS - command->sent_s)},
                     {"changed_age_s", Short(nowS - command->changed_s)}};
        if (command->kind == OrderKind::ORDER_GOTO)
        {
            item["latitude_deg"] = Latitude(command->latitude_deg);
            item["longitude_deg"] = Longitude(command->longitude_deg);
            item["altitude_m"] = Rounded(command->altitude_m, 10);
        }
        items.push_back(std::move(item));
    }
    return items;
}

const char *WireName(StationEvent::Weight weight)
{
    switch (weight)
    {
        case StationEvent::Weight::Info:
            return "info";
        case StationEvent::Weight::Warning:
            return "warning";
        case StationEvent::Weight::Alarm:
            return "alarm";
    }
    return "info";
}

Json ToJson(const std::deque<StationEvent> &events, double nowS)
{
    Json items = Json::array();
    const auto listed = std::min(events.size(), EventsInSnapshot);
    for (auto event = std::prev(events.end(), static_cast<std::ptrdiff_t>(listed)); event != events.end();
         ++event)
        items.push_back({{"number", event->Number},
                         {"age_s", Short(nowS - event->AtS)},
                         {"weight", WireName(event->How)},
                         {"node", event->Node},
                         {"text", event->Text}});
    return items;
}

Json ToJson(const std::vector<Rabit::Gateway::Problem> &problems)
{
    Json items = Json::array();
    for (const Rabit::Gateway::Problem &problem : problems)
    {
        if (items.size() == ProblemsInSnapshot)
            break;
        items.push_back({{"subject", problem.subject}, {"node", problem.node}, {"reason", problem.reason}});
    }
    return {{"count", problems.size()}, {"items", std::move(items)}};
}

// Bytes a second. Values that are not set are null.
Json ToJson(const Rabit::Gateway::AirStatus &air)
{
    const auto limit = [](double value) { return value > 0 ? Rounded(value, 1) : Json(nullptr); };
    Json object = {{"budget", limit(air.budget)},
                   {"capacity", limit(air.capacity)},
                   {"used", Rounded(air.used, 1)},
                   {"classes", Json::array()}};
    const auto add = [&classes = object["classes"]](const char *name, double rate) {
        classes.push_back({{"name", name}, {"rate", Rounded(rate, 1)}});
    };
    for (const auto &[name, rate] : Rabit::ClassRates)
        add(name, air.*rate);
    add("discovery", air.discovery);
    return object;
}

Json ToJson(const RadioUse &use)
{
    if (!use.Known)
        return nullptr;
    Json streams = Json::array();
    for (std::size_t i = 0; i < std::min(use.Streams.size(), HeldInSnapshot); ++i)
        streams.push_back({{"message", use.Streams[i].Message},
                           {"posted_per_s", Rounded(use.Streams[i].PostedPerS, 10)},
                           {"sent_per_s", Rounded(use.Streams[i].SentPerS, 10)}});
    Json links = Json::array();
    for (std::size_t i = 0; i < std::min(use.Links.size(), HeldInSnapshot); ++i)
        links.push_back({{"node", use.Links[i].Node},
                         {"queue", use.Links[i].Queue},
                         {"waiting", use.Links[i].Waiting},
                         {"expired", use.Links[i].Expired}});
    return {{"air", ToJson(use.Air)},
            {"posts_held_per_s", Rounded(use.PostsHeldPerS, 10)},
            {"messages_held", use.MessagesHeld},
            {"streams", {{"count", use.Streams.size()}, {"items", std::move(streams)}}},
            {"links", {{"count", use.Links.size()}, {"items", std::move(links)}}}};
}
}  // namespace

std::string SnapshotText(const StationData &data, const std::deque<StationEvent> &events)
{
    Json aircraft = Json::array();
    for (const AircraftData &one : data.Aircraft)
        aircraft.push_back(ToJson(one));
    Json targets = Json::array();
    for (const ListedTarget &target : TargetsOf(data))
        targets.push_back(ToJson(target));
    Json snapshot = {{"type", "snapshot"},
                     {"node", data.Node},
                     {"life", data.Life},
                     {"number", data.Number},
                     {"server_s", Short(data.NowS)},
                     {"fleet_age_s", Short(data.FleetAgeS)},
                     {"aircraft", std::move(aircraft)},
                     {"targets", std::move(targets)},
                     {"events", ToJson(events, data.NowS)},
                     {"problems", ToJson(data.Problems)},
                     {"replayed", data.Replayed},
                     {"radio", ToJson(data.Radio)}};
    AddAreas(snapshot, data.Areas);
    if (data.Fence && data.Fence.Content->radius_m > 0)
        Add(snapshot, "fence", data.Fence);
    snapshot["commands"] = data.Commands ? ToJson(*data.Commands.Content, data.Commands.AgeS) : Json::array();
    return snapshot.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace Ground
