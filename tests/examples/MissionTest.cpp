// The rules of class Mission, one by one.
#include "mission/Mission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace
{
using Swarm::GeoPoint;
using Swarm::Mission;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Stage = Uav::CommandStage;
using Mode = Uav::MissionMode;

const GeoPoint Field{47.4, 8.5, 510};
constexpr double Gps = 1.4e9;

// Records the mission's output.
class Output : public Swarm::MissionOutput
{
public:
    struct Course
    {
        GeoPoint Point;
        float SpeedMps;
    };

    std::uint32_t Fly(const GeoPoint &point, float speedMps) override
    {
        if (!TakesCourses)
            return 0;
        Courses.push_back({point, speedMps});
        return static_cast<std::uint32_t>(Courses.size());
    }
    void Answer(const std::string &, const Uav::CommandAck &ack) override { Acks.push_back(ack); }
    bool Send(const std::string &aircraft, const Uav::TargetReport &report) override
    {
        if (Unreachable == aircraft)
            return false;
        Reports.emplace_back(aircraft, report);
        return true;
    }
    bool Send(const std::string &aircraft, const Uav::Validation &validation) override
    {
        Validations.emplace_back(aircraft, validation);
        return true;
    }
    // Returns the stages of a command, in order.
    std::vector<Stage> StagesOf(std::uint32_t id) const
    {
        std::vector<Stage> stages;
        for (const Uav::CommandAck &ack : Acks)
            if (ack.id == id)
                stages.push_back(ack.stage);
        return stages;
    }
    std::vector<std::string> Asked() const
    {
        std::vector<std::string> asked;
        for (const auto &[aircraft, report] : Reports)
            asked.push_back(aircraft);
        return asked;
    }

    bool TakesCourses = true;
    std::string Unreachable;
    std::vector<Course> Courses;
    std::vector<Uav::CommandAck> Acks;
    std::vector<std::pair<std::string, Uav::TargetReport>> Reports;
    std::vector<std::pair<std::string, Uav::Validation>> Validations;
};

// uav2, whose neighbours are uav1 (100 m away) and uav3 (200 m).
class MissionOf2 : public testing::Test
{
protected:
    Output _output;
    std::optional<Mission> _mission{std::in_place, "uav2", _output};
    Swarm::Situation _now;

    void SetUp() override
    {
        _now.Position = Field;
        _now.BatteryPercent = 90;
        _now.Others["uav1"] = PoseAt(100);
        _now.Others["uav3"] = PoseAt(-200);
        Pass(0);
    }
    static Uav::Pose PoseAt(double eastM)
    {
        const GeoPoint place = Swarm::Moved(Field, {0, eastM, 0});
        Uav::Pose pose;
        pose.latitude_deg = place.LatitudeDeg;
        pose.longitude_deg = place.LongitudeDeg;
        return pose;
    }
    // Lets time pass; the autopilot flies the last course.
    void Pass(double seconds)
    {
        _now.NowS += seconds;
        _now.GpsTimeS = Gps + _now.NowS;
        _now.Flight.course = static_cast<std::uint32_t>(_output.Courses.size());
        _mission->Update(_now);
        _mission->Act();
    }
    void Arrive()
    {
        _now.Flight.phase = Uav::FlightPhase::FLIGHT_HOLD;
        Pass(0.2);
        _now.Flight.phase = Uav::FlightPhase::FLIGHT_COURSE;
    }
    static Uav::SearchArea AreaAt(float altitudeM, std::uint32_t number = 1)
    {
        Uav::SearchArea area;
        area.number = number;
        area.latitude_deg = Field.LatitudeDeg;
        area.longitude_deg = Field.LongitudeDeg;
        area.altitude_m = altitudeM;
        area.north_m = 200;
        area.east_m = 400;
        area.speed_mps = 16;
        area.lane_m = 50;
        return area;
    }
    void GiveArea(std::uint32_t number = 1) { EXPECT_EQ(_mission->Take(AreaAt(510, number)), ""); }
    void CommandSearch(std::uint32_t id = 1)
    {
        Uav::Search search;
        search.id = id;
        search.reply_to = "ground/Commands";
        _mission->Take(search);
        Pass(0.2);
    }
    void CommandGoto(std::uint32_t id)
    {
        Uav::Goto command;
        command.id = id;
        command.reply_to = "ground/Commands";
        command.latitude_deg = Field.LatitudeDeg;
        command.longitude_deg = Field.LongitudeDeg;
        command.altitude_m = 600;
        command.speed_mps = 10;
        _mission->Take(command);
        Pass(0.2);
    }
    void CommandHome(std::uint32_t id = 0)
    {
        Uav::GoHome home;
        home.id = id;
        home.reason = "the battery is low";
        _mission->Take(home);
        Pass(0.2);
    }
    // Reports a target as sensor fusion does: seen now by this aircraft's own camera.
    void See(double northM, const std::string &foundBy = "uav2", std::uint32_t number = 7)
    {
        const GeoPoint place = Swarm::Moved(Field, {northM, 0, 0});
        Uav::Target target;
        target.name.aircraft = "uav2";
        target.name.number = number;
        target.name.since_gps_time_s = Gps;
        target.found_by = foundBy;
        target.latitude_deg = place.LatitudeDeg;
        target.longitude_deg = place.LongitudeDeg;
        target.sigma_major_m = 2;
        target.own_detections = 5;
        target.own_gps_time_s = Gps + _now.NowS + 0.1;
        _now.Targets.items = {target};
        Pass(0.2);
    }
    void Confirm()
    {
        GiveArea();
        CommandSearch();
        See(30);
        ASSERT_EQ(State().mode, Mode::MISSION_CONFIRM);
    }
    void Answer(const std::string &node, bool accepted, bool busy = false)
    {
        Uav::Validation validation;
        validation.target = 7;
        validation.node = node;
        validation.accepted = accepted;
        validation.busy = busy;
        _mission->Take(validation);
        Pass(0.2);
    }
    void BeAsked(const std::string &by, double northM)
    {
        const GeoPoint place = Swarm::Moved(Field, {northM, 0, 0});
        Uav::TargetReport report;
        report.target = 4;
        report.name.aircraft = by;
        report.name.number = 4;
        report.seen_by = by;
        report.latitude_deg = place.LatitudeDeg;
        report.longitude_deg = place.LongitudeDeg;
        report.sigma_m = 2;
        _mission->Take(report);
        Pass(0.2);
    }
    Uav::MissionState State() const
    {
        Uav::MissionState state;
        _mission->Describe(state);
        return state;
    }
    Uav::TargetStage StageOfFinding() const { return _mission->Findings().at(0).stage; }
    Uav::Validation LastValidation() const
    {
        return _output.Validations.empty() ? Uav::Validation() : _output.Validations.back().second;
    }
};

TEST_F(MissionOf2, DoesNothingUntilItIsTold)
{
    GiveArea();
    See(30);
    Pass(100);
    EXPECT_EQ(State().mode, Mode::MISSION_IDLE);
    EXPECT_THAT(_output.Courses, IsEmpty());
    EXPECT_THAT(_output.Reports, IsEmpty());
}

TEST_F(MissionOf2, GoesToAPointAndSaysWhenItIsThere)
{
    CommandGoto(5);
    EXPECT_EQ(State().mode, Mode::MISSION_GOTO);
    EXPECT_EQ(_output.Courses.back().Point.AltitudeM, 600);
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED));
    Arrive();
    EXPECT_EQ(State().mode, Mode::MISSION_HOLD);
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED, Stage::COMMAND_DONE));
    EXPECT_EQ(State().last_command, 5u);
    EXPECT_EQ(State().commands, 1u);
}

TEST_F(MissionOf2, HasNotArrivedWhenTheAutopilotHoldsAnotherPoint)
{
    CommandGoto(5);
    _now.Flight.phase = Uav::FlightPhase::FLIGHT_HOLD;
    _now.Flight.course = 0;
    _mission->Update(_now);
    _mission->Act();
    EXPECT_EQ(State().mode, Mode::MISSION_GOTO);
}

TEST_F(MissionOf2, SaysThatACommandWasReplaced)
{
    CommandGoto(5);
    CommandGoto(6);
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED, Stage::COMMAND_REPLACED));
    EXPECT_EQ(_output.Acks[1].replaced_by, 6u);
    EXPECT_EQ(_output.Acks[1].reason, "") << "the numbers of commands belong to whoever gives them";
}

TEST_F(MissionOf2, HoldsForEverWithoutATrack)
{
    CommandGoto(5);
    Arrive();
    Pass(1000);
    EXPECT_EQ(State().mode, Mode::MISSION_HOLD);
}

TEST_F(MissionOf2, GoesBackToItsTrackAfterAWhile)
{
    _now.Flight.phase = Uav::FlightPhase::FLIGHT_RECORDING;
    Pass(1);
    _now.Flight.phase = Uav::FlightPhase::FLIGHT_COURSE;
    CommandGoto(5);
    Arrive();
    Pass(Mission::BackToTrackS - 1);
    _now.Flight.phase = Uav::FlightPhase::FLIGHT_HOLD;
    EXPECT_EQ(State().mode, Mode::MISSION_HOLD);
    Pass(1.1);
    EXPECT_EQ(State().mode, Mode::MISSION_IDLE);
    EXPECT_EQ(_output.Courses.back().SpeedMps, 0);
}

TEST_F(MissionOf2, GoesHomeWhereItStarted)
{
    _now.Position = Swarm::Moved(Field, {1000, 0, 0});
    Pass(10);
    CommandHome();
    EXPECT_EQ(State().mode, Mode::MISSION_HOME);
    EXPECT_EQ(State().text, "the battery is low");
    EXPECT_NEAR(Swarm::LevelDistanceM(_output.Courses.back().Point, Field), 0, 0.01);
    EXPECT_EQ(State().commands, 0u) << "the health monitor's are not counted";
}

TEST_F(MissionOf2, GoingHomeReplacesACommand)
{
    CommandGoto(5);
    CommandHome();
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED, Stage::COMMAND_REPLACED));
    EXPECT_EQ(_output.Acks[1].reason, "it goes home");
    EXPECT_EQ(_output.Acks[1].replaced_by, 0u);
}

TEST_F(MissionOf2, TellsWhereHomeIs)
{
    EXPECT_TRUE(State().has_home);
    EXPECT_NEAR(State().home_latitude_deg, Field.LatitudeDeg, 1e-5);
    EXPECT_NEAR(State().home_longitude_deg, Field.LongitudeDeg, 1e-5);
    EXPECT_FALSE(State().has_floor);
    EXPECT_FALSE(State().has_ground);
}

// uav2 over ground at 430 m, above which it keeps 30 m.
class MissionAboveGround : public MissionOf2
{
protected:
    void SetUp() override
    {
        _mission.emplace("uav2", _output, Swarm::Floor({.GroundM = 430, .ClearanceM = 30}));
        MissionOf2::SetUp();
    }
    static Uav::Goto GotoAt(double altitudeM)
    {
        Uav::Goto command;
        command.id = 5;
        command.reply_to = "ground/Commands";
        command.latitude_deg = Field.LatitudeDeg;
        command.longitude_deg = Field.LongitudeDeg;
        command.altitude_m = altitudeM;
        command.speed_mps = 10;
        return command;
    }
};

TEST_F(MissionAboveGround, DeclinesAPointBelowItsFloorAndSaysWhy)
{
    _mission->Take(GotoAt(50));
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_DECLINED));
    EXPECT_EQ(_output.Acks[0].reason,
              "50 m above sea level is 380 m below the ground and below the floor of 460 m");
    EXPECT_THAT(_output.Courses, IsEmpty());
    EXPECT_EQ(State().mode, Mode::MISSION_IDLE);
}

TEST_F(MissionAboveGround, FliesToAPointOnItsFloor)
{
    _mission->Take(GotoAt(460));
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED));
}

TEST_F(MissionAboveGround, DeclinesASearchAreaBelowItsFloor)
{
    const std::string why = "100 m above sea level is 330 m below the ground and below the floor of 460 m";
    GiveArea();
    CommandSearch(1);
    const std::size_t courses = _output.Courses.size();
    EXPECT_EQ(_mission->Take(AreaAt(100)), why);
    Pass(1);
    EXPECT_EQ(State().area_declined, why);
    EXPECT_EQ(State().search_area, 1u) << "it goes on with the one before";
    for (std::size_t i = courses; i < _output.Courses.size(); ++i)
        EXPECT_GE(_output.Courses[i].Point.AltitudeM, 460);
    EXPECT_EQ(_mission->Take(AreaAt(470)), "");
    EXPECT_EQ(State().area_declined, "") << "a good one is in force again";
}

TEST_F(MissionAboveGround, DeclinesToSearchWhileTheLastAreaIsDeclined)
{
    GiveArea();
    EXPECT_NE(_mission->Take(AreaAt(100)), "");
    CommandSearch(6);
    EXPECT_THAT(_output.StagesOf(6), ElementsAre(Stage::COMMAND_DECLINED));
    EXPECT_THAT(_output.Acks[0].reason,
                HasSubstr("search area: 100 m above sea level is 330 m below the ground"));
    EXPECT_EQ(State().mode, Mode::MISSION_IDLE);
}

TEST_F(MissionAboveGround, GoesHomeNoLowerThanItsFloor)
{
    Mission started("uav2", _output, Swarm::Floor({.GroundM = 430, .ClearanceM = 30}));
    _now.Position->AltitudeM = 430;
    started.Update(_now);
    Uav::GoHome home;
    home.id = 7;
    started.Take(home);
    EXPECT_THAT(_output.StagesOf(7), ElementsAre(Stage::COMMAND_ACCEPTED));
    ASSERT_FALSE(_output.Courses.empty());
    EXPECT_EQ(_output.Courses.back().Point.AltitudeM, 460);
}

TEST_F(MissionAboveGround, TellsItsFloorAndTheGround)
{
    EXPECT_TRUE(State().has_floor);
    EXPECT_EQ(State().floor_m, 460);
    EXPECT_TRUE(State().has_ground);
    EXPECT_EQ(State().ground_m, 430);
}

TEST_F(MissionOf2, DeclinesAllButGoingHomeWhileTheBatteryIsLow)
{
    GiveArea();
    _now.BatteryPercent = 24;
    Pass(1);
    CommandGoto(5);
    CommandSearch(6);
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_DECLINED));
    EXPECT_THAT(_output.StagesOf(6), ElementsAre(Stage::COMMAND_DECLINED));
    EXPECT_EQ(_output.Acks[0].reason, "the battery is low");
    CommandHome(7);
    EXPECT_THAT(_output.StagesOf(7), ElementsAre(Stage::COMMAND_ACCEPTED));
}

TEST_F(MissionOf2, FliesWithABatteryThatIsNotKnown)
{
    _now.BatteryPercent = std::numeric_limits<float>::quiet_NaN();
    Pass(1);
    CommandGoto(5);
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED));
}

TEST_F(MissionOf2, DeclinesASearchWithoutAnArea)
{
    CommandSearch(5);
    EXPECT_EQ(_output.Acks.at(0).reason, "no search area is known");
    EXPECT_EQ(State().mode, Mode::MISSION_IDLE);
}

TEST_F(MissionOf2, SearchesFromItsFirstLaneOn)
{
    GiveArea();
    CommandSearch(5);
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED));
    _now.Position = _output.Courses.back().Point;
    Pass(1);
    EXPECT_EQ(State().mode, Mode::MISSION_SEARCH);
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED, Stage::COMMAND_DONE));
}

TEST_F(MissionOf2, TakesANewAreaAtOnce)
{
    GiveArea(1);
    CommandSearch();
    _now.Position = _output.Courses.back().Point;
    Pass(1);
    Uav::SearchArea other;
    other.number = 2;
    other.latitude_deg = 47.5;
    other.longitude_deg = 8.5;
    other.north_m = other.east_m = 100;
    other.speed_mps = 12;
    other.lane_m = 50;
    EXPECT_EQ(_mission->Take(other), "");
    Pass(0.2);
    EXPECT_EQ(State().search_area, 2u);
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
    EXPECT_NEAR(_output.Courses.back().Point.LatitudeDeg, 47.5, 0.001);
    EXPECT_EQ(_output.Courses.back().SpeedMps, 12);
}

TEST_F(MissionOf2, KeepsItsAreaWhenAnOlderOneComes)
{
    GiveArea(5);
    Uav::SearchArea older = AreaAt(510, 4);
    older.latitude_deg += 0.1;
    EXPECT_EQ(_mission->Take(older), "");
    EXPECT_EQ(State().search_area, 5u);
    CommandSearch();
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
}

// Its numbers are not reported, so the next one may be lower.
TEST_F(MissionOf2, TakesAnAreaWithALowerNumberThanOneThatItDeclined)
{
    GiveArea(3);
    Uav::SearchArea wrong;
    wrong.number = 7;
    EXPECT_NE(_mission->Take(wrong), "");
    GiveArea(4);
    EXPECT_EQ(State().search_area, 4u);
    EXPECT_EQ(State().area_declined, "");
}

TEST_F(MissionOf2, KeepsItsAreaWhenANewOneMakesNoSense)
{
    GiveArea(1);
    Uav::SearchArea wrong;
    wrong.number = 2;
    EXPECT_NE(_mission->Take(wrong), "");
    EXPECT_EQ(State().search_area, 1u);
}

Uav::Geofence FenceOf(double radiusM)
{
    Uav::Geofence fence;
    fence.latitude_deg = Field.LatitudeDeg;
    fence.longitude_deg = Field.LongitudeDeg;
    fence.radius_m = radiusM;
    return fence;
}

Uav::Goto GotoNorth(double metres, std::uint32_t id)
{
    const GeoPoint point = Swarm::Moved(Field, {metres, 0, 0});
    Uav::Goto command;
    command.id = id;
    command.latitude_deg = point.LatitudeDeg;
    command.longitude_deg = point.LongitudeDeg;
    command.altitude_m = 500;
    command.speed_mps = 10;
    return command;
}

TEST_F(MissionOf2, DeclinesAPointOutsideOfTheGeofence)
{
    _mission->Take(FenceOf(3000));
    _mission->Take(GotoNorth(2999, 5));
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED));
    _mission->Take(GotoNorth(3250, 6));
    EXPECT_THAT(_output.StagesOf(6), ElementsAre(Stage::COMMAND_DECLINED));
    EXPECT_EQ(_output.Acks.back().reason, "250 m outside of the geofence");
    Uav::Goto wrongSign = GotoNorth(0, 7);
    wrongSign.latitude_deg = -wrongSign.latitude_deg;
    _mission->Take(wrongSign);
    EXPECT_EQ(_output.Acks.back().reason, "10538.3 km outside of the geofence");
    EXPECT_EQ(State().mode, Mode::MISSION_GOTO) << "it flies on to the point inside";
}

TEST_F(MissionOf2, WithoutAGeofenceFliesAnywhere)
{
    _mission->Take(FenceOf(100));
    _mission->Take(FenceOf(0));
    _mission->Take(GotoNorth(100'000, 5));
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED));
}

TEST_F(MissionOf2, AGeofenceThatIsNoNumberEnclosesNothing)
{
    _mission->Take(FenceOf(std::numeric_limits<double>::quiet_NaN()));
    _mission->Take(GotoNorth(10, 5));
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_DECLINED));
}

TEST_F(MissionOf2, SaysUntilWhenItsCauseToFlyHomeHeld)
{
    _now.WantsHome = true;
    Pass(0);
    Uav::GoHome home;
    home.reason = "the ground station was silent";
    _mission->Take(home);
    Pass(0.2);
    EXPECT_EQ(State().text, "the ground station was silent");
    _now.WantsHome = false;
    _now.NowS = 0;
    Pass(60);
    EXPECT_EQ(State().text, "the ground station was silent (until 16:54:02 UTC)");
    Pass(60);
    EXPECT_EQ(State().text, "the ground station was silent (until 16:54:02 UTC)");
}

TEST_F(MissionOf2, FliesHomeFromOutsideOfTheGeofence)
{
    Uav::Geofence far = FenceOf(100);
    far.latitude_deg += 1;
    _mission->Take(far);
    Uav::GoHome home;
    home.id = 5;
    _mission->Take(home);
    EXPECT_THAT(_output.StagesOf(5), ElementsAre(Stage::COMMAND_ACCEPTED));
}

TEST_F(MissionOf2, DeclinesASearchAreaThatReachesOutOfTheGeofenceUntilTheFenceIsWider)
{
    _mission->Take(FenceOf(100));
    Uav::SearchArea area;
    area.number = 1;
    area.latitude_deg = Field.LatitudeDeg;
    area.longitude_deg = Field.LongitudeDeg;
    area.north_m = area.east_m = 200;
    area.altitude_m = 510;
    area.speed_mps = 12;
    area.lane_m = 50;
    EXPECT_EQ(_mission->Take(area), "41 m outside of the geofence") << "its corners";
    EXPECT_EQ(State().area_declined, "41 m outside of the geofence");
    EXPECT_EQ(_mission->Take(FenceOf(150)), "");
    EXPECT_EQ(State().area_declined, "");
    EXPECT_EQ(State().search_area, 1u);
    EXPECT_EQ(_mission->Take(FenceOf(100)), "41 m outside of the geofence");
}

// The search area reaches 224 m far, the target of another aircraft lies farther.
TEST_F(MissionOf2, DeclinesToLookAtATargetOutsideOfTheGeofence)
{
    _mission->Take(FenceOf(250));
    GiveArea();
    CommandSearch();
    BeAsked("uav1", 500);
    EXPECT_EQ(LastValidation().reason, "250 m outside of the geofence");
    EXPECT_FALSE(LastValidation().busy) << "it is not to be asked again";
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
    BeAsked("uav1", 200);
    EXPECT_EQ(State().mode, Mode::MISSION_VALIDATE);
}

TEST_F(MissionOf2, EndsAValidationWhenItsPlaceIsOutsideOfTheGeofence)
{
    GiveArea();
    CommandSearch();
    BeAsked("uav1", 500);
    ASSERT_EQ(State().mode, Mode::MISSION_VALIDATE);
    _mission->Take(FenceOf(250));
    const std::size_t courses = _output.Courses.size();
    Pass(0.2);
    EXPECT_EQ(LastValidation().reason, "250 m outside of the geofence");
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
    EXPECT_EQ(_output.Courses.size(), courses);
}

TEST_F(MissionOf2, DoesNotTakeUpATargetOutsideOfTheGeofenceAndSearchesOn)
{
    _mission->Take(FenceOf(250));
    GiveArea();
    CommandSearch();
    See(500);
    Pass(0.2);
    EXPECT_TRUE(State().mode == Mode::MISSION_TRANSIT || State().mode == Mode::MISSION_SEARCH);
    EXPECT_THAT(_output.Reports, IsEmpty());
    EXPECT_EQ(StageOfFinding(), Uav::TargetStage::TARGET_REJECTED);
    for (const Output::Course &course : _output.Courses)
        EXPECT_LT(Swarm::LevelDistanceM(course.Point, Field), 260) << "the lanes' ends are at 251 m";
}

TEST_F(MissionOf2, GivesUpATargetThatMovesOutOfTheGeofence)
{
    _mission->Take(FenceOf(250));
    Confirm();
    See(300);
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
    EXPECT_EQ(StageOfFinding(), Uav::TargetStage::TARGET_REJECTED);
}

TEST_F(MissionOf2, FollowsATargetNoFartherThanTheGeofence)
{
    _mission->Take(FenceOf(250));
    Confirm();
    Answer("uav1", true);
    See(240);
    ASSERT_EQ(State().mode, Mode::MISSION_TRACK);
    See(300);
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
    EXPECT_EQ(StageOfFinding(), Uav::TargetStage::TARGET_TRACKED);
    for (const Output::Course &course : _output.Courses)
        EXPECT_LT(Swarm::LevelDistanceM(course.Point, Field), 260) << "the lanes' ends are at 251 m";
}

TEST_F(MissionOf2, ASearchUnderWayGoesOnWhenTheGeofenceChanges)
{
    GiveArea();
    CommandSearch();
    const GeoPoint begin = _output.Courses.back().Point;
    _now.Position = begin;
    Pass(0.2);
    ASSERT_EQ(State().mode, Mode::MISSION_SEARCH);
    const std::size_t courses = _output.Courses.size();
    EXPECT_EQ(_mission->Take(FenceOf(3000)), "");
    EXPECT_EQ(State().mode, Mode::MISSION_SEARCH);
    _now.Position = Swarm::Moved(Field, {0, 0, 0});
    Pass(0.2);
    for (std::size_t i = courses; i < _output.Courses.size(); ++i)
        EXPECT_GT(Swarm::LevelDistanceM(_output.Courses[i].Point, begin), 1) << "not back to the begin";
    EXPECT_NE(_mission->Take(FenceOf(100)), "");
    EXPECT_EQ(State().mode, Mode::MISSION_SEARCH);
    EXPECT_NE(State().area_declined, "");
}

TEST_F(MissionOf2, SendsACourseAgainThatTheAutopilotDoesNotFly)
{
    GiveArea();
    CommandSearch();
    const std::size_t courses = _output.Courses.size();
    _now.NowS += Mission::RepeatS + 0.1;
    _now.Flight.course = 0;  // it was silent
    _mission->Update(_now);
    _mission->Act();
    EXPECT_EQ(_output.Courses.size(), courses + 1);
}

TEST_F(MissionOf2, AsksTheNearestAircraftAboutATargetAndCirclesItMeanwhile)
{
    Confirm();
    EXPECT_THAT(_output.Asked(), ElementsAre("uav1"));
    EXPECT_EQ(_output.Reports[0].second.target, 7u);
    EXPECT_EQ(_output.Reports[0].second.seen_by, "uav2");
    EXPECT_EQ(_output.Reports[0].second.sigma_m, 2);
    EXPECT_EQ(State().partner, "uav1");
    EXPECT_EQ(State().target, "uav2/7");
    EXPECT_EQ(StageOfFinding(), Uav::TargetStage::TARGET_VALIDATING);
    Pass(0.2);
    EXPECT_NEAR(Swarm::Between(Field, _output.Courses.back().Point).NorthM, 30, 0.1);
    EXPECT_EQ(_output.Courses.back().Point.AltitudeM, 520);
}

TEST_F(MissionOf2, LeavesATargetToWhoeverSawItFirst)
{
    GiveArea();
    CommandSearch();
    See(30, "uav3");
    EXPECT_THAT(_output.Reports, IsEmpty());
}

TEST_F(MissionOf2, TakesUpTheTargetOfAnAircraftThatIsGone)
{
    GiveArea();
    CommandSearch();
    See(30, "uav9");
    EXPECT_EQ(State().mode, Mode::MISSION_CONFIRM);
}

TEST_F(MissionOf2, LeavesATargetThatAnotherAircraftPursues)
{
    Uav::Finding finding;
    const GeoPoint place = Swarm::Moved(Field, {35, 5, 0});
    finding.latitude_deg = place.LatitudeDeg;
    finding.longitude_deg = place.LongitudeDeg;
    _now.OthersFindings["uav3"].items = {finding};
    GiveArea();
    CommandSearch();
    See(30);
    EXPECT_THAT(_output.Reports, IsEmpty());
}

TEST_F(MissionOf2, TracksATargetThatWasValidatedAndSearchesOn)
{
    Confirm();
    Answer("uav1", true);
    EXPECT_EQ(State().mode, Mode::MISSION_TRACK);
    EXPECT_EQ(StageOfFinding(), Uav::TargetStage::TARGET_TRACKED);
    EXPECT_EQ(_mission->Findings()[0].validated_by, "uav1");
    Pass(Mission::TrackS);
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
    EXPECT_NEAR(_mission->Findings()[0].tracked_s, Mission::TrackS, 0.5);
    See(30);
    Pass(1000);
    EXPECT_EQ(_mission->Findings().size(), 1u) << "it knows the target";
    EXPECT_NE(State().mode, Mode::MISSION_CONFIRM);
}

TEST_F(MissionOf2, FollowsATargetThatMoves)
{
    Confirm();
    Answer("uav1", true);
    See(60);
    EXPECT_NEAR(Swarm::Between(Field, _output.Courses.back().Point).NorthM, 60, 0.1);
}

TEST_F(MissionOf2, AsksTheNextWhenOneHasNotSeenIt)
{
    Confirm();
    Answer("uav1", false);
    EXPECT_THAT(_output.Asked(), ElementsAre("uav1", "uav3"));
}

TEST_F(MissionOf2, AsksTheNextWhenNoAnswerComes)
{
    Confirm();
    Pass(Mission::AnswerS + 1);
    EXPECT_THAT(_output.Asked(), ElementsAre("uav1", "uav3"));
}

TEST_F(MissionOf2, AsksTheNextWhenTheAskedOneIsGone)
{
    Confirm();
    _now.Others.erase("uav1");
    Pass(1);
    EXPECT_THAT(_output.Asked(), ElementsAre("uav1", "uav3"));
}

TEST_F(MissionOf2, AsksTheNextWhenOneCannotBeReached)
{
    _output.Unreachable = "uav1";
    Confirm();
    EXPECT_THAT(_output.Asked(), ElementsAre("uav3"));
}

TEST_F(MissionOf2, RejectsATargetThatNobodyCouldSee)
{
    Confirm();
    Answer("uav1", false);
    Answer("uav3", false);
    EXPECT_EQ(StageOfFinding(), Uav::TargetStage::TARGET_REJECTED);
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
    See(30);
    EXPECT_EQ(_output.Reports.size(), 2u) << "not at once again";
}

TEST_F(MissionOf2, GivesARejectedTargetAnotherChanceMuchLater)
{
    Confirm();
    Answer("uav1", false);
    Answer("uav3", false);
    Pass(Swarm::TargetBook::AgainAfterS);
    See(30);
    EXPECT_EQ(State().mode, Mode::MISSION_CONFIRM);
    EXPECT_EQ(_mission->Findings().size(), 1u);
}

TEST_F(MissionOf2, AsksThoseThatWereBusyOnceMoreAndForAMinute)
{
    Confirm();
    Answer("uav1", false, true);
    Answer("uav3", false, true);
    EXPECT_EQ(State().mode, Mode::MISSION_CONFIRM);
    EXPECT_EQ(State().partner, "");
    Pass(Mission::AskAgainS + 0.1);
    EXPECT_THAT(_output.Asked(), ElementsAre("uav1", "uav3", "uav1"));
    Pass(Mission::PatienceS - Mission::AskAgainS - 1);
    _now.NowS += 5;
    Answer("uav1", false, true);
    Answer("uav3", false, true);
    EXPECT_EQ(StageOfFinding(), Uav::TargetStage::TARGET_REJECTED);
}

TEST_F(MissionOf2, IgnoresValidationsThatItDidNotAskFor)
{
    Confirm();
    Answer("uav3", true);
    EXPECT_EQ(State().mode, Mode::MISSION_CONFIRM);
}

TEST_F(MissionOf2, SearchesInALayerOfItsOwn)
{
    GiveArea();
    CommandSearch();
    EXPECT_EQ(_output.Courses.back().Point.AltitudeM, 510 + Mission::LayerM);
}

TEST_F(MissionOf2, ValidatesATargetThatItsOwnCameraHasSeenSinceItWasAsked)
{
    GiveArea();
    CommandSearch();
    See(80, "uav1");
    BeAsked("uav1", 80);
    EXPECT_EQ(State().mode, Mode::MISSION_VALIDATE);
    EXPECT_EQ(State().target, "uav1/4");
    EXPECT_THAT(_output.Validations, IsEmpty()) << "what it saw before does not count";
    EXPECT_NEAR(Swarm::Between(Field, _output.Courses.back().Point).NorthM, 80, 0.1);
    EXPECT_EQ(_output.Courses.back().Point.AltitudeM, 520) << "uav2 keeps to the second layer";
    See(82, "uav1");
    EXPECT_TRUE(LastValidation().accepted);
    EXPECT_EQ(LastValidation().target, 4u);
    EXPECT_EQ(LastValidation().node, "uav2");
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
}

TEST_F(MissionOf2, DoesNotValidateATargetSomewhereElse)
{
    GiveArea();
    CommandSearch();
    BeAsked("uav1", 80);
    See(0, "uav1");
    EXPECT_THAT(_output.Validations, IsEmpty());
}

TEST_F(MissionOf2, GivesUpLookingAfterAWhile)
{
    GiveArea();
    CommandSearch();
    BeAsked("uav1", 80);
    Pass(Mission::ValidateS + 1);
    EXPECT_FALSE(LastValidation().accepted);
    EXPECT_FALSE(LastValidation().busy);
    EXPECT_EQ(LastValidation().reason, "it was not to be seen");
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
}

TEST_F(MissionOf2, IsBusyUnlessItSearches)
{
    BeAsked("uav1", 80);
    EXPECT_TRUE(LastValidation().busy);
    EXPECT_EQ(LastValidation().reason, "it does something else");
    EXPECT_EQ(State().mode, Mode::MISSION_IDLE) << "nothing flies off without being told";
}

TEST_F(MissionOf2, TellsTheAskingAircraftWhenACommandCallsItAway)
{
    GiveArea();
    CommandSearch();
    BeAsked("uav1", 80);
    CommandGoto(9);
    EXPECT_FALSE(LastValidation().accepted);
    EXPECT_EQ(LastValidation().reason, "it was commanded to do something else");
}

TEST_F(MissionOf2, LeavesItsTargetToAnEarlierNameThatPursuesIt)
{
    Confirm();
    BeAsked("uav1", 33);
    EXPECT_EQ(State().mode, Mode::MISSION_VALIDATE);
    EXPECT_THAT(_mission->Findings(), IsEmpty());
}

TEST_F(MissionOf2, KeepsItsTargetAgainstALaterName)
{
    Confirm();
    BeAsked("uav3", 33);
    EXPECT_EQ(State().mode, Mode::MISSION_CONFIRM);
    EXPECT_EQ(LastValidation().reason, "it pursues that target itself");
}

TEST_F(MissionOf2, LeavesItsTargetWhenAnEarlierNameListsIt)
{
    Confirm();
    _now.OthersFindings["uav1"].items = _mission->Findings();
    Pass(0.2);
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
    EXPECT_THAT(_mission->Findings(), IsEmpty());
}

TEST_F(MissionOf2, GivesWayToAnEarlierNameWhenBothWait)
{
    Confirm();
    Answer("uav1", false, true);
    Answer("uav3", false, true);
    BeAsked("uav1", 150);
    EXPECT_EQ(State().mode, Mode::MISSION_VALIDATE);
    EXPECT_EQ(StageOfFinding(), Uav::TargetStage::TARGET_FOUND) << "taken up again later";
}

TEST_F(MissionOf2, TakesATargetUpAgainThatACommandCalledItAwayFrom)
{
    Confirm();
    CommandGoto(5);
    EXPECT_EQ(StageOfFinding(), Uav::TargetStage::TARGET_FOUND);
    CommandSearch(6);
    See(30);
    EXPECT_EQ(State().mode, Mode::MISSION_CONFIRM);
    EXPECT_EQ(_mission->Findings().size(), 1u);
}

TEST_F(MissionOf2, KeepsTheNameOfATargetWithinWhatAMessageTakes)
{
    GiveArea();
    CommandSearch();
    BeAsked(std::string(64, 'a'), 80);
    EXPECT_EQ(State().mode, Mode::MISSION_VALIDATE);
    EXPECT_EQ(State().target, std::string(62, 'a') + "/4");
}

TEST_F(MissionOf2, KnowsItsTargetByTheNameIntoWhichItsOwnWasMerged)
{
    Confirm();
    Uav::Target target = _now.Targets.items.at(0);
    target.formerly = {target.name};
    target.name.aircraft = "uav1";
    target.name.number = 3;
    target.name.since_gps_time_s -= 100;
    _now.Targets.items = {target};
    Pass(0.2);
    EXPECT_EQ(State().target, "uav1/3");
    ASSERT_EQ(_mission->Findings().size(), 1u);
    EXPECT_EQ(_mission->Findings()[0].name, target.name);
    Answer("uav1", true);
    EXPECT_EQ(State().mode, Mode::MISSION_TRACK) << "the answer still finds it";
}

TEST_F(MissionOf2, LeavesATargetThatAnotherAircraftPursuesUnderAFormerName)
{
    Uav::Finding finding;
    finding.name.aircraft = "uav3";
    finding.name.number = 2;
    finding.name.since_gps_time_s = Gps + 50;
    finding.latitude_deg = Field.LatitudeDeg + 0.001;  // where it saw it last
    finding.longitude_deg = Field.LongitudeDeg;
    _now.OthersFindings["uav3"].items = {finding};
    GiveArea();
    CommandSearch();
    Uav::Target target;
    target.name.aircraft = "uav2";
    target.name.number = 7;
    target.formerly = {finding.name};
    target.found_by = "uav2";
    target.latitude_deg = Field.LatitudeDeg;
    target.longitude_deg = Field.LongitudeDeg;
    target.own_detections = 5;
    target.own_gps_time_s = Gps + _now.NowS + 0.1;
    _now.Targets.items = {target};
    Pass(0.2);
    EXPECT_THAT(_output.Reports, IsEmpty());
}

TEST_F(MissionOf2, PursuesATargetBesideOneThatAnotherAircraftHasFound)
{
    Uav::Finding finding;
    finding.name.aircraft = "uav3";
    finding.name.number = 2;
    finding.latitude_deg = Field.LatitudeDeg + 0.0003;
    finding.longitude_deg = Field.LongitudeDeg;
    _now.OthersFindings["uav3"].items = {finding};
    Uav::Target other;
    other.name = finding.name;
    other.found_by = "uav3";
    _now.Targets.items = {other};
    GiveArea();
    CommandSearch();
    Uav::Target target;
    target.name.aircraft = "uav2";
    target.name.number = 7;
    target.found_by = "uav2";
    target.latitude_deg = Field.LatitudeDeg + 0.0004;
    target.longitude_deg = Field.LongitudeDeg;
    target.own_detections = 5;
    target.own_gps_time_s = Gps + _now.NowS + 0.1;
    _now.Targets.items = {other, target};
    Pass(0.2);
    EXPECT_EQ(State().mode, Mode::MISSION_CONFIRM) << "names tell them apart, though they are near";
}

TEST_F(MissionOf2, IgnoresReportsThatMakeNoSense)
{
    GiveArea();
    CommandSearch();
    Uav::TargetReport report;
    report.seen_by = "uav1";
    report.latitude_deg = std::numeric_limits<double>::quiet_NaN();
    _mission->Take(report);
    Pass(0.2);
    EXPECT_EQ(State().mode, Mode::MISSION_TRANSIT);
}

}  // namespace
