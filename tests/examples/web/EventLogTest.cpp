#include "EventLog.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace
{
using Ground::RowState;
using Weight = Ground::StationEvent::Weight;
using testing::ElementsAre;

class EventLog : public testing::Test
{
protected:
    Ground::StationData _data;
    Ground::EventLog _log;
    Uav::MissionState _mission;
    Uav::Health _health;
    Uav::Findings _findings;
    Ground::CommandList _commands;
    Ground::AreaList _areas;
    std::uint64_t _told = 0;

    void SetUp() override { _data.Aircraft.emplace_back().Node = "uav1"; }
    Ground::AircraftData &Aircraft() { return _data.Aircraft.front(); }
    void StartCommand()
    {
        Ground::CommandStatus command;
        command.id = 90001;
        command.number = 1;
        command.node = "uav1";
        command.kind = Ground::OrderKind::ORDER_HOME;
        _commands.items = {command};
        _data.Commands = {&_commands, 0};
        AddStep(Ground::CommandProgress::PROGRESS_SENT);
    }
    void AddStep(Ground::CommandProgress progress, const std::string &reason = "")
    {
        Ground::CommandStep step;
        step.progress = progress;
        step.reason = reason;
        _commands.items[0].steps.push_back(step);
    }
    // Returns the events since the last call.
    std::vector<std::string> New()
    {
        _log.Look(_data);
        std::vector<std::string> texts;
        for (const auto &event : _log.Events())
            if (event.Number > _told)
                texts.push_back(event.Node + "|" + event.Text);
        _told = _log.Events().empty() ? 0 : _log.Events().back().Number;
        return texts;
    }
};

TEST_F(EventLog, TellsWhenTheStateOfAnAircraftChanges)
{
    EXPECT_THAT(New(), ElementsAre());
    Aircraft().State = RowState::Up;
    EXPECT_THAT(New(), ElementsAre("uav1|UP"));
    EXPECT_THAT(New(), ElementsAre());
    Aircraft().State = RowState::Lost;
    Aircraft().Reason = "not heard for 3.5 s";
    _data.NowS = 7;
    EXPECT_THAT(New(), ElementsAre("uav1|LOST: not heard for 3.5 s"));
    EXPECT_EQ(_log.Events().back().How, Weight::Alarm);
    EXPECT_EQ(_log.Events().back().AtS, 7);
}

TEST_F(EventLog, TellsWhatTheAircraftDoAndFind)
{
    _mission.mode = Uav::MissionMode::MISSION_SEARCH;
    _mission.text = "lane 2 of 7";
    Aircraft().Mission = {&_mission, 0};
    EXPECT_THAT(New(), ElementsAre("uav1|search: lane 2 of 7"));
    _mission.text = "lane 3 of 7";
    EXPECT_THAT(New(), ElementsAre());
    Uav::Finding finding;
    finding.name.aircraft = "uav1";
    finding.name.number = 4;
    _findings.items = {finding};
    Aircraft().Findings = {&_findings, 0};
    EXPECT_THAT(New(), ElementsAre("uav1|target uav1/4 found"));
    _findings.items[0].stage = Uav::TargetStage::TARGET_VALIDATED;
    _findings.items[0].validated_by = "uav2";
    EXPECT_THAT(New(), ElementsAre("uav1|target uav1/4 validated (seen by uav2)"));
    _health.wants_home = true;
    _health.reason = "battery low";
    Aircraft().Health = {&_health, 0};
    EXPECT_THAT(New(), ElementsAre("uav1|goes home by itself: battery low"));
}

TEST_F(EventLog, TellsHowCommandsGoOn)
{
    StartCommand();
    EXPECT_THAT(New(), ElementsAre("uav1|command 1 (home) sent"));
    EXPECT_THAT(New(), ElementsAre());
    AddStep(Ground::CommandProgress::PROGRESS_DECLINED, "no home");
    EXPECT_THAT(New(), ElementsAre("uav1|command 1 (home) declined: no home"));
    EXPECT_EQ(_log.Events().back().How, Weight::Warning);
}

TEST_F(EventLog, TellsEveryStepOfACommandThatWentThroughSeveralAtOnce)
{
    StartCommand();
    AddStep(Ground::CommandProgress::PROGRESS_DELIVERED);
    AddStep(Ground::CommandProgress::PROGRESS_ACCEPTED);
    EXPECT_THAT(New(), ElementsAre("uav1|command 1 (home) sent", "uav1|command 1 (home) delivered",
                                   "uav1|command 1 (home) accepted"));
    AddStep(Ground::CommandProgress::PROGRESS_REPLACED, "command 4");
    EXPECT_THAT(New(), ElementsAre("uav1|command 1 (home) replaced: command 4"));
}

TEST_F(EventLog, TellsThatAnAircraftDeclinesTheSearchArea)
{
    Aircraft().Mission = {&_mission, 0};
    New();
    _mission.area_declined = "100 m above sea level is below the floor of 460 m";
    EXPECT_THAT(New(),
                ElementsAre("uav1|declines the search area: 100 m above sea level is below the floor of "
                            "460 m"));
    EXPECT_EQ(_log.Events().back().How, Weight::Warning);
    EXPECT_THAT(New(), ElementsAre());
    _mission.area_declined = "";
    EXPECT_THAT(New(), ElementsAre("uav1|takes the search area"));
}

TEST_F(EventLog, TellsThatAnAircraftIsBackWithoutOrders)
{
    New();
    Aircraft().WithoutOrders = true;
    EXPECT_THAT(New(), ElementsAre("uav1|is back without orders"));
    EXPECT_EQ(_log.Events().back().How, Weight::Warning);
    EXPECT_THAT(New(), ElementsAre());
    Aircraft().WithoutOrders = false;
    EXPECT_THAT(New(), ElementsAre());
}

TEST_F(EventLog, TellsThatASearchAreaIsGivenAndThenHowManyFlyIt)
{
    Ground::AreaStatus &area = _areas.items.emplace_back();
    area.area.number = 2;
    area.answers.resize(3);
    for (std::size_t i = 0; i < 3; ++i)
        area.answers[i].node = "uav" + std::to_string(i + 1);
    _data.Areas = {&_areas, 0};
    EXPECT_THAT(New(), ElementsAre("|Search area 2 is given to the fleet"));
    area.answers[0].progress = Ground::AreaProgress::AREA_DECLINED;
    EXPECT_THAT(New(), ElementsAre()) << "the others have not answered";
    area.answers[1].progress = area.answers[2].progress = Ground::AreaProgress::AREA_DECLINED;
    EXPECT_THAT(New(), ElementsAre("|0 of 3 fly area 2; declined by uav1, uav2, uav3"));
    EXPECT_EQ(_log.Events().back().How, Weight::Warning);
    EXPECT_THAT(New(), ElementsAre());
    for (auto &answer : area.answers)
        answer.progress = Ground::AreaProgress::AREA_FLOWN;
    EXPECT_THAT(New(), ElementsAre("|3 of 3 fly area 2"));
    EXPECT_EQ(_log.Events().back().How, Weight::Info);
}

TEST_F(EventLog, WaitsNotForEverForTheAnswersToASearchArea)
{
    Ground::AreaStatus &area = _areas.items.emplace_back();
    area.area.number = 2;
    area.answers.emplace_back().node = "uav1";
    _data.Areas = {&_areas, 0};
    New();
    _data.NowS += Ground::EventLog::AreaAnswersS;
    EXPECT_THAT(New(), ElementsAre("|0 of 1 fly area 2; not answered by uav1"));
}

TEST_F(EventLog, TellsOfABadPositionOnceUntilItIsGoodAgainForAWhile)
{
    New();
    Aircraft().BadPosition = "latitude must be from -90 to 90, not 95";
    EXPECT_THAT(New(), ElementsAre("uav1|bad position: latitude must be from -90 to 90, not 95"));
    EXPECT_EQ(_log.Events().back().How, Weight::Warning);
    Aircraft().BadPosition = "";
    EXPECT_THAT(New(), ElementsAre());
    Aircraft().BadPosition = "latitude must be from -90 to 90, not 96";
    EXPECT_THAT(New(), ElementsAre()) << "that is the same trouble";
    Aircraft().BadPosition = "";
    _data.NowS += Ground::EventLog::PositionHoldsS;
    EXPECT_THAT(New(), ElementsAre("uav1|has a good position again"));
}

TEST_F(EventLog, TellsOfProblemsOnce)
{
    Rabit::Gateway::Problem problem;
    problem.subject = "subscribe Pose";
    problem.node = "uav3";
    problem.reason = "other type";
    _data.Problems = {problem, problem};
    EXPECT_THAT(New(), ElementsAre());
    _data.NowS += Ground::EventLog::ProblemLastsS;
    EXPECT_THAT(New(), ElementsAre("uav3|subscribe Pose: other type"));
    EXPECT_EQ(_log.Events().back().How, Weight::Info) << "signs are for what an operator has to look at";
    EXPECT_THAT(New(), ElementsAre());
    _data.Problems.clear();
    EXPECT_THAT(New(), ElementsAre());
    _data.Problems = {problem};
    EXPECT_THAT(New(), ElementsAre());
    _data.NowS += Ground::EventLog::ProblemLastsS;
    EXPECT_THAT(New(), ElementsAre("uav3|subscribe Pose: other type"));
}

TEST_F(EventLog, TellsOnceOfAProblemWhoseTextComesLaterAndOnceOfManyThatBeginTogether)
{
    Rabit::Gateway::Problem problem;
    problem.subject = "uav3: 1 problem";
    problem.node = "uav3";
    problem.reason = "see its log";
    _data.Problems = {problem};
    EXPECT_THAT(New(), ElementsAre());
    _data.NowS += 2;
    _data.Problems[0].reason = "subscribe Pose: other type";
    EXPECT_THAT(New(), ElementsAre());
    _data.NowS += Ground::EventLog::ProblemLastsS;
    EXPECT_THAT(New(), ElementsAre("uav3|uav3: 1 problem: subscribe Pose: other type"));
    _data.Problems.clear();
    for (const char *const message : {"Pose", "Health", "Findings"})
    {
        problem.subject = std::string("subscribe ") + message;
        problem.reason = "nothing has been received";
        _data.Problems.push_back(problem);
    }
    EXPECT_THAT(New(), ElementsAre());
    _data.NowS += Ground::EventLog::ProblemLastsS;
    EXPECT_THAT(New(), ElementsAre("uav3|subscribe Pose: nothing has been received; and 2 more problems"));
}

TEST_F(EventLog, TellsWhyAnAircraftNeedNotBeAtHomeAnyMore)
{
    _health.wants_home = true;
    _health.reason = "the ground station is silent";
    Aircraft().Health = {&_health, 0};
    EXPECT_THAT(New(), ElementsAre("uav1|goes home by itself: the ground station is silent"));
    _health.wants_home = false;
    _health.reason = "";
    EXPECT_THAT(
        New(),
        ElementsAre("uav1|no longer flies home by itself; this is over: the ground station is silent"));
}

TEST_F(EventLog, TellsThatASearchHasBegunAndNotThatItIsDone)
{
    _commands.items.resize(1);
    _commands.items[0].node = "uav1";
    _commands.items[0].number = 1;
    _commands.items[0].kind = Ground::OrderKind::ORDER_SEARCH;
    AddStep(Ground::CommandProgress::PROGRESS_DONE);
    _data.Commands = {&_commands, 0};
    EXPECT_THAT(New(), ElementsAre("uav1|command 1 (search) begun"));
}

TEST_F(EventLog, IsBounded)
{
    for (int i = 0; i < 1000; ++i)
    {
        Aircraft().State = i % 2 == 0 ? RowState::Up : RowState::Stale;
        _log.Look(_data);
    }
    EXPECT_EQ(_log.Events().size(), Ground::EventLog::MaxEvents);
    EXPECT_EQ(_log.Events().back().Number, 1000u);
    Aircraft().Findings = {&_findings, 0};
    for (std::uint32_t i = 0; i < 3 * Ground::EventLog::MaxFollowed; ++i)
    {
        Uav::Finding finding;
        finding.name.aircraft = "uav1";
        finding.name.number = i;
        _findings.items = {finding};
        _log.Look(_data);
    }
    EXPECT_EQ(_log.Events().back().Number, 1000u + Ground::EventLog::MaxFollowed);
}

}  // namespace
