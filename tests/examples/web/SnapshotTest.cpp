#include "Snapshot.h"

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace
{
using Ground::RowState;
using Json = nlohmann::json;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr float NaNf = std::numeric_limits<float>::quiet_NaN();

class Snapshot : public testing::Test
{
protected:
    Ground::StationData _data;
    std::deque<Ground::StationEvent> _events;
    Uav::Pose _pose;
    Uav::Health _health;
    Uav::MissionState _mission;
    Ground::CommandList _commands;

    Ground::AircraftData &Aircraft()
    {
        if (_data.Aircraft.empty())
            _data.Aircraft.emplace_back().Node = "uav1";
        return _data.Aircraft.front();
    }
    Json Shown() const { return Json::parse(Ground::SnapshotText(_data, _events)); }
};

TEST_F(Snapshot, TellsTheGeofenceIfThereIsOne)
{
    Uav::Geofence fence;
    _data.Fence = {&fence, 1.0};
    EXPECT_FALSE(Shown().contains("fence"));
    fence.latitude_deg = 47.5;
    fence.radius_m = 3000;
    EXPECT_EQ(Shown()["fence"]["latitude_deg"], 47.5);
    EXPECT_EQ(Shown()["fence"]["radius_m"], 3000);
}

TEST_F(Snapshot, TellsWhatIsKnownWithTheAgeOfEachPart)
{
    _pose.latitude_deg = 47.123456789;
    _pose.velocity_north_mps = 3;
    _pose.velocity_east_mps = 4;
    Aircraft().State = RowState::Up;
    Aircraft().Pose = {&_pose, 0.25};
    Aircraft().Health = {&_health, 1.5};
    Aircraft().RoundTripS = 0.0021;
    Aircraft().DeliveryRate = 3210.4;
    _data.NowS = 12.5;
    _data.FleetAgeS = 0.5;
    const Json shown = Shown();
    EXPECT_EQ(shown["server_s"], 12.5);
    EXPECT_EQ(shown["fleet_age_s"], 0.5);
    const Json &aircraft = shown["aircraft"][0];
    EXPECT_EQ(aircraft["node"], "uav1");
    EXPECT_EQ(aircraft["state"], "up");
    EXPECT_EQ(aircraft["round_trip_s"], 0.0021);
    EXPECT_EQ(aircraft["delivery_rate"], 3210);
    EXPECT_EQ(aircraft["pose"]["latitude_deg"], 47.1234568);
    EXPECT_EQ(aircraft["pose"]["speed_mps"], 5);
    EXPECT_EQ(aircraft["pose"]["age_s"], 0.25);
    EXPECT_EQ(aircraft["health"]["age_s"], 1.5);
    EXPECT_FALSE(aircraft.contains("mission")) << "none has come";
}

TEST_F(Snapshot, TellsNothingOfWhatIsNotKnown)
{
    _health.battery_percent = NaNf;
    _pose.latitude_deg = NaN;
    _pose.altitude_m = std::numeric_limits<double>::infinity();
    _pose.longitude_deg = std::numeric_limits<double>::max();
    Aircraft().Health = {&_health, 0};
    Aircraft().Pose = {&_pose, 0};
    const Json shown = Shown();
    const Json &aircraft = shown["aircraft"][0];
    EXPECT_TRUE(aircraft["health"]["battery_percent"].is_null());
    EXPECT_TRUE(aircraft["round_trip_s"].is_null());
    EXPECT_TRUE(aircraft["delivery_rate"].is_null());
    EXPECT_TRUE(shown["radio"].is_null()) << "there is no Fleet at all";
    EXPECT_TRUE(aircraft["pose"]["latitude_deg"].is_null());
    EXPECT_TRUE(aircraft["pose"]["longitude_deg"].is_null());
    EXPECT_TRUE(aircraft["pose"]["altitude_m"].is_null());
    EXPECT_TRUE(shown["fleet_age_s"].is_null()) << "there is no Fleet at all";
    EXPECT_FALSE(shown.contains("area"));
    EXPECT_EQ(shown["commands"], Json::array());
}

TEST_F(Snapshot, TellsNoPlaceThatIsNotOnTheEarth)
{
    _pose.latitude_deg = 95;
    _pose.longitude_deg = 1e300;
    Aircraft().Pose = {&_pose, 0};
    Aircraft().BadPosition = "latitude must be from -90 to 90, not 95";
    Uav::CameraView camera;
    camera.corners[0].latitude_deg = -91;
    Aircraft().Camera = {&camera, 0};
    Uav::Targets targets;
    targets.items.emplace_back().longitude_deg = 181;
    Aircraft().Targets = {&targets, 0};
    const Json shown = Shown();
    const Json &aircraft = shown["aircraft"][0];
    EXPECT_TRUE(aircraft["pose"]["latitude_deg"].is_null());
    EXPECT_TRUE(aircraft["pose"]["longitude_deg"].is_null());
    EXPECT_EQ(aircraft["bad_position"], "latitude must be from -90 to 90, not 95");
    EXPECT_TRUE(aircraft["camera"]["corners"][0][0].is_null());
    EXPECT_TRUE(shown["targets"][0]["longitude_deg"].is_null());
}

TEST_F(Snapshot, TellsEachSearchAreaWithItsOutcome)
{
    EXPECT_EQ(Shown()["areas"], Json::array());
    Ground::AreaList areas;
    areas.posted_s = 20;
    areas.items.resize(2);
    areas.items[0].area.number = 1;
    Ground::AreaStatus &wanted = areas.items[1];
    wanted.area.number = 2;
    wanted.area.north_m = 400;
    wanted.given_s = 18;
    wanted.answers.resize(2);
    wanted.answers[0].node = "uav1";
    wanted.answers[0].progress = Ground::AreaProgress::AREA_DECLINED;
    wanted.answers[0].reason = "too low";
    wanted.answers[0].flies = 1;
    wanted.answers[1].node = "uav2";
    wanted.answers[1].progress = Ground::AreaProgress::AREA_FLOWN;
    _data.Areas = {&areas, 0.5};
    const Json shown = Shown();
    EXPECT_EQ(shown["area"]["number"], 2) << "the wanted one";
    EXPECT_EQ(shown["area"]["north_m"], 400);
    ASSERT_EQ(shown["areas"].size(), 2u);
    const Json &one = shown["areas"][1];
    EXPECT_EQ(one["number"], 2);
    EXPECT_EQ(one["given_age_s"], 2.5);
    EXPECT_EQ(one["flown_by"], 1);
    EXPECT_EQ(one["answers"][0],
              Json({{"node", "uav1"}, {"progress", "declined"}, {"reason", "too low"}, {"flies", 1}}));
}

TEST_F(Snapshot, TellsFloorGroundAndHomeWhereTheyAreKnown)
{
    Aircraft().Mission = {&_mission, 0};
    EXPECT_TRUE(Shown()["aircraft"][0]["floor_m"].is_null());
    EXPECT_TRUE(Shown()["aircraft"][0]["ground_m"].is_null());
    EXPECT_TRUE(Shown()["aircraft"][0]["home"].is_null());
    _mission.has_floor = _mission.has_ground = _mission.has_home = true;
    _mission.floor_m = 460;
    _mission.ground_m = 430;
    _mission.home_latitude_deg = 47.5F;
    _mission.home_longitude_deg = 8.5F;
    _mission.area_declined = "too low";
    const Json aircraft = Shown()["aircraft"][0];
    EXPECT_EQ(aircraft["floor_m"], 460);
    EXPECT_EQ(aircraft["ground_m"], 430);
    EXPECT_EQ(aircraft["home"], Json({{"latitude_deg", 47.5}, {"longitude_deg", 8.5}}));
    EXPECT_EQ(aircraft["mission"]["area_declined"], "too low");
}

TEST_F(Snapshot, TellsWhatIsReplayed)
{
    EXPECT_EQ(Shown()["replayed"], Json::array());
    _data.Replayed = {"replay.uav1", "replay.uav2"};
    EXPECT_EQ(Shown()["replayed"], Json({"replay.uav1", "replay.uav2"}));
}

TEST_F(Snapshot, TellsWhichAircraftIsBackWithoutOrders)
{
    EXPECT_FALSE(Shown()["aircraft"][0].contains("without_orders"));
    Aircraft().WithoutOrders = true;
    EXPECT_EQ(Shown()["aircraft"][0]["without_orders"], true);
}

TEST_F(Snapshot, PassesTextsOnAsTheyAreIfTheyAreUtf8)
{
    _mission.text = "</script><img src=x onerror=alert(1)>\"\n";
    Aircraft().Mission = {&_mission, 0};
    EXPECT_EQ(Shown()["aircraft"][0]["mission"]["text"], _mission.text);
    _mission.text = "bad \xFF\xC0 bytes";
    EXPECT_THAT(Shown()["aircraft"][0]["mission"]["text"].get<std::string>(),
                testing::StartsWith("bad \xEF\xBF\xBD"));
}

TEST_F(Snapshot, GivesAgesToCommandsByTheirLastChange)
{
    Ground::CommandStatus early;
    early.number = 1;
    early.node = "uav1";
    early.progress = Ground::CommandProgress::PROGRESS_DONE;
    early.sent_s = 10;
    early.changed_s = 14;
    Ground::CommandStatus late = early;
    late.number = 2;
    late.progress = Ground::CommandProgress::PROGRESS_IN_DOUBT;
    late.sent_s = late.changed_s = 20;
    _commands.items = {early, late};
    _data.Commands = {&_commands, 0.5};
    const Json shown = Shown()["commands"];
    EXPECT_EQ(shown[0]["progress"], "done");
    EXPECT_EQ(shown[0]["sent_age_s"], 10.5);
    EXPECT_EQ(shown[0]["changed_age_s"], 6.5);
    EXPECT_EQ(shown[1]["progress"], "in doubt");
    EXPECT_EQ(shown[1]["changed_age_s"], 0.5);
}

TEST_F(Snapshot, HoldsTheNewestCommandsAndEventsOnly)
{
    for (std::uint32_t i = 1; i <= 100; ++i)
    {
        Ground::CommandStatus command;
        command.number = i;
        _commands.items.push_back(command);
        _events.push_back({i, 0, Ground::StationEvent::Weight::Alarm, "uav1", "text"});
    }
    _data.Commands = {&_commands, 0};
    const Json shown = Shown();
    EXPECT_EQ(shown["commands"].size(), Ground::CommandsInSnapshot);
    EXPECT_EQ(shown["commands"].back()["number"], 100);
    EXPECT_EQ(shown["events"].size(), Ground::EventsInSnapshot);
    EXPECT_EQ(shown["events"].back()["number"], 100);
    EXPECT_EQ(shown["events"].back()["weight"], "alarm");
}

TEST_F(Snapshot, TellsWhatKeepsDataFromFlowingNow)
{
    EXPECT_EQ(Shown()["problems"], Json({{"count", 0}, {"items", Json::array()}}));
    Rabit::Gateway::Problem problem;
    problem.subject = "subscribe Pse";
    problem.node = "uav1";
    problem.reason = "uav1 does not publish `Pse`";
    _data.Problems = {problem};
    const Json shown = Shown()["problems"];
    EXPECT_EQ(shown["count"], 1);
    EXPECT_EQ(
        shown["items"][0],
        Json({{"subject", "subscribe Pse"}, {"node", "uav1"}, {"reason", "uav1 does not publish `Pse`"}}));
}

TEST_F(Snapshot, HoldsTheFirstProblemsAndCountsAll)
{
    _data.Problems.resize(1000);
    _data.Problems[0].subject = "first";
    const Json shown = Shown()["problems"];
    EXPECT_EQ(shown["count"], 1000);
    EXPECT_EQ(shown["items"].size(), Ground::ProblemsInSnapshot);
    EXPECT_EQ(shown["items"][0]["subject"], "first");
}

TEST_F(Snapshot, TellsWhatTheRadioDoesAndWhatIsHeldBack)
{
    _data.Radio.Known = true;
    _data.Radio.Air.budget = 5000;
    _data.Radio.Air.used = 4940.4;
    _data.Radio.Air.presence = 400;
    _data.Radio.Air.command = 90;
    _data.Radio.Air.state = 30;
    _data.Radio.Air.telemetry = 4200;
    _data.Radio.Air.bulk = 10;
    _data.Radio.Air.foreign = 20;
    _data.Radio.Air.discovery = 210;
    _data.Radio.Streams = {{"Pose", 10, 6.24}};
    _data.Radio.PostsHeldPerS = 3.76;
    _data.Radio.Links = {{"uav2", "MissionControl", 3, 2}};
    _data.Radio.MessagesHeld = 3;
    const Json shown = Shown()["radio"];
    EXPECT_EQ(shown["air"], Json({{"budget", 5000},
                                  {"capacity", nullptr},
                                  {"used", 4940},
                                  {"classes",
                                   {{{"name", "presence"}, {"rate", 400}},
                                    {{"name", "command"}, {"rate", 90}},
                                    {{"name", "state"}, {"rate", 30}},
                                    {{"name", "telemetry"}, {"rate", 4200}},
                                    {{"name", "bulk"}, {"rate", 10}},
                                    {{"name", "foreign"}, {"rate", 20}},
                                    {{"name", "discovery"}, {"rate", 210}}}}}));
    EXPECT_EQ(shown["posts_held_per_s"], 3.8);
    EXPECT_EQ(shown["messages_held"], 3);
    EXPECT_EQ(
        shown["streams"],
        Json({{"count", 1}, {"items", {{{"message", "Pose"}, {"posted_per_s", 10}, {"sent_per_s", 6.2}}}}}));
    EXPECT_EQ(
        shown["links"],
        Json({{"count", 1},
              {"items", {{{"node", "uav2"}, {"queue", "MissionControl"}, {"waiting", 3}, {"expired", 2}}}}}));
}

TEST_F(Snapshot, HoldsTheFirstOfWhatIsHeldBackAndCountsAll)
{
    _data.Radio.Known = true;
    _data.Radio.Streams.resize(100);
    _data.Radio.Links.resize(1000);
    const Json shown = Shown()["radio"];
    EXPECT_EQ(shown["streams"]["count"], 100);
    EXPECT_EQ(shown["streams"]["items"].size(), Ground::HeldInSnapshot);
    EXPECT_EQ(shown["links"]["count"], 1000);
    EXPECT_EQ(shown["links"]["items"].size(), Ground::HeldInSnapshot);
}

TEST_F(Snapshot, TellsNothingOfARadioWhoseNumbersMakeNoSense)
{
    _data.Radio.Known = true;
    _data.Radio.Air.budget = NaN;
    _data.Radio.Air.capacity = -1;
    _data.Radio.Air.used = std::numeric_limits<double>::infinity();
    _data.Radio.Air.bulk = NaN;
    _data.Radio.PostsHeldPerS = std::numeric_limits<double>::max();
    _data.Radio.Streams = {{"\xFF", NaN, NaN}};
    Aircraft().DeliveryRate = std::numeric_limits<double>::infinity();
    const Json whole = Shown();
    const Json &shown = whole["radio"];
    for (const char *name : {"budget", "capacity", "used"})
        EXPECT_TRUE(shown["air"][name].is_null()) << name;
    EXPECT_TRUE(shown["air"]["classes"][4]["rate"].is_null());  // bulk
    EXPECT_TRUE(shown["posts_held_per_s"].is_null());
    EXPECT_EQ(shown["streams"]["items"][0]["message"], "\xEF\xBF\xBD");
    EXPECT_TRUE(shown["streams"]["items"][0]["sent_per_s"].is_null());
    EXPECT_TRUE(whole["aircraft"][0]["delivery_rate"].is_null());
}

TEST_F(Snapshot, TellsOfTargetsHowLongTheyWereNotSeenByTheClockOfTheAircraft)
{
    Uav::Targets targets;
    targets.gps_time_s = 1000;
    Uav::Target target;
    target.name.aircraft = "uav1";
    target.name.number = 3;
    target.seen_gps_time_s = 996;
    target.seen_by = {"uav1", "uav2"};
    targets.items = {target};
    Aircraft().Targets = {&targets, 0.1};
    const Json shown = Shown()["targets"][0];
    EXPECT_EQ(shown["name"], "uav1/3");
    EXPECT_EQ(shown["unseen_s"], 4);
    EXPECT_EQ(shown["seen_by"].size(), 2u);
    EXPECT_EQ(shown["age_s"], 0.1);
}

}  // namespace
