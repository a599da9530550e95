#include "FleetView.h"

#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/gateway/GatewayManager.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace
{
using namespace std::chrono_literals;
using Ground::RowState;
using Rabit::Gateway::NodeState;
using testing::HasSubstr;

class FleetView : public testing::Test
{
protected:
    std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace _workspace{_clock};
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::ostringstream _out;
    Rabit::RabitSteppedReactor _reactor{_workspace};
    const Ground::FleetView *_view = nullptr;
    double _roundTripS = std::numeric_limits<double>::quiet_NaN();

    void SetUp() override
    {
        _workspace.AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
        _workspace.AddPublishSubscribeMessage("uav1/Pose", _pose);
    }
    void Start(const std::vector<std::string> &expected)
    {
        auto view = std::make_unique<Ground::FleetView>(Ground::FleetView::Settings{expected, {{"Slow", 1}}},
                                                        Ground::FleetView::Output{_out, false}, _workspace);
        _view = view.get();
        _reactor.AddManager(std::move(view));
        _reactor.Start();
    }
    // Shows the fleet with uav1 in this state; returns the printed text.
    std::string Show(NodeState state)
    {
        Rabit::Gateway::NodeStatus status;
        status.node = "uav1";
        status.state = state;
        status.round_trip_s = _roundTripS;
        _fleet->nodes = {status};
        _fleet->PostMessage();
        return Printed();
    }
    std::string Printed()
    {
        _out.str("");
        _reactor.RunFor(*_clock, 1s);
        return _out.str();
    }
    RowState State() const { return _view->Result().at(0).Row.State; }
};

TEST_F(FleetView, ShowsAnExpectedAircraftBeforeItIsHeard)
{
    Start({"uav1"});
    EXPECT_THAT(Printed(), HasSubstr("uav1   WAITING no pose yet"));
    ASSERT_EQ(_view->Result().size(), 1u);
    EXPECT_EQ(State(), RowState::Waiting);
}

TEST_F(FleetView, TellsOnceWhatAnAircraftDeclines)
{
    auto mission = std::make_shared<Uav::MissionState>();
    _workspace.AddPublishSubscribeMessage("uav1/MissionState", mission);
    Start({"uav1"});
    mission->area_declined = "100 m above sea level is below the floor of 460 m";
    mission->PostMessage();
    const std::string line =
        "         uav1: the search area is declined: 100 m above sea level is below the floor "
        "of 460 m\n";
    EXPECT_THAT(Show(NodeState::UP), HasSubstr(line));
    EXPECT_THAT(Show(NodeState::UP), testing::Not(HasSubstr(line))) << "a log says it once";
}

TEST_F(FleetView, TellsOnceHowManyFlyTheSearchArea)
{
    auto list = std::make_shared<Ground::AreaList>();
    _workspace.AddPublishSubscribeMessage("AreaList", list);
    Start({"uav1"});
    Ground::AreaStatus &area = list->items.emplace_back();
    area.area.number = 2;
    Ground::AreaAnswer &answer = area.answers.emplace_back();
    answer.node = "uav1";
    answer.progress = Ground::AreaProgress::AREA_DECLINED;
    list->PostMessage();
    const std::string line = "         Search area: 0 of 1 fly area 2; declined by uav1\n";
    EXPECT_THAT(Show(NodeState::UP), HasSubstr(line));
    EXPECT_THAT(Show(NodeState::UP), testing::Not(HasSubstr(line))) << "a log says it once";
    list->items[0].answers[0].progress = Ground::AreaProgress::AREA_FLOWN;
    list->PostMessage();
    EXPECT_THAT(Show(NodeState::UP), HasSubstr("Search area: 1 of 1 fly area 2\n"));
}

TEST_F(FleetView, ShowsNoNumbersOfABadPosition)
{
    Start({"uav1"});
    _pose->altitude_m = 1e300;
    _pose->PostMessage();
    const std::string text = Show(NodeState::UP);
    EXPECT_THAT(text, HasSubstr(" s) bad position, mission"));
    EXPECT_THAT(text, HasSubstr("uav1: bad position: altitude must be from -1000 to 30000, not 1e+300\n"));
}

TEST_F(FleetView, TellsWhyACommandIsDeclined)
{
    auto list = std::make_shared<Ground::CommandList>();
    _workspace.AddPublishSubscribeMessage("CommandList", list);
    Start({"uav1"});
    Ground::CommandStatus command;
    command.node = "uav1";
    command.number = 3;
    command.progress = Ground::CommandProgress::PROGRESS_DECLINED;
    command.reason = "the battery is low";
    list->items = {command};
    list->PostMessage();
    EXPECT_THAT(Show(NodeState::UP), HasSubstr("uav1: command 3 (goto) is declined: the battery is low\n"));
}

TEST_F(FleetView, DoesNotTakeANodeForAnAircraftUntilItsPoseComes)
{
    Start({});
    Show(NodeState::UP);
    EXPECT_TRUE(_view->Result().empty());
    _pose->PostMessage();
    Show(NodeState::UP);
    EXPECT_EQ(_view->Result().size(), 1u);
}

TEST_F(FleetView, FollowsTheStateOfANode)
{
    Start({"uav1"});
    Show(NodeState::UP);
    EXPECT_EQ(State(), RowState::Up);
    Show(NodeState::STALE);
    EXPECT_EQ(State(), RowState::Stale);
    Show(NodeState::LOST);
    EXPECT_EQ(State(), RowState::Lost);
}

TEST_F(FleetView, ShowsTheLastPoseOfALostNodeAsOld)
{
    Start({"uav1"});
    _pose->PostMessage();
    Show(NodeState::UP);
    EXPECT_THAT(Show(NodeState::LOST), HasSubstr("LOST    OLD pose (age"));
}

TEST_F(FleetView, TrustsNoFleetThatHasStoppedComing)
{
    Start({"uav1"});
    Show(NodeState::UP);
    for (int i = 0; i < 4; ++i)
        Printed();
    EXPECT_EQ(State(), RowState::Stale);
}

TEST_F(FleetView, PutsNamesInTheOrderOfTheirNumbers)
{
    Start({"uav10", "uav2", "uav1"});
    Printed();
    std::vector<std::string> names;
    for (const auto &seen : _view->Result())
        names.push_back(seen.Row.Node);
    EXPECT_THAT(names, testing::ElementsAre("uav1", "uav2", "uav10"));
}

TEST_F(FleetView, ShowsWhatKeepsDataFromFlowingAsLongAsItIsSo)
{
    Start({"uav1"});
    Rabit::Gateway::Problem problem;
    problem.subject = "subscribe Pse";
    problem.node = "uav1";
    problem.reason = "uav1 does not publish `Pse`";
    _fleet->problems = {problem};
    EXPECT_THAT(Show(NodeState::UP), HasSubstr("1 problem: subscribe Pse (uav1)"));
    EXPECT_THAT(Show(NodeState::UP), HasSubstr("1 problem: subscribe Pse (uav1)"));
    _fleet->problems.clear();
    EXPECT_THAT(Show(NodeState::UP), testing::Not(HasSubstr("problem")));
}

TEST_F(FleetView, ShowsTheRadioInOneShortLineWhileNothingLimitsIt)
{
    Start({"uav1"});
    EXPECT_THAT(Printed(), testing::Not(HasSubstr("radio")));
    _fleet->air.used = 1230;
    EXPECT_THAT(Show(NodeState::UP), HasSubstr(" s  radio not limited, 1.2 kB/s used\n"));
}

TEST_F(FleetView, ShowsWhatIsHeldBackByABudgetButNotByTheConfiguration)
{
    Start({"uav1"});
    _fleet->air.budget = 5000;
    _fleet->publications.resize(2);
    _fleet->publications[0].message = "Pose";
    _fleet->publications[1].message = "Slow";
    for (int i = 0; i < 3; ++i)
    {
        for (auto &publication : _fleet->publications)
            publication.offered += 10;
        _fleet->publications[0].replaced += 4;
        _fleet->publications[1].replaced += 9;
        Show(NodeState::UP);
    }
    EXPECT_THAT(_out.str(), HasSubstr("held back: 4.0 posts/s; Pose: 10.0/s posted, 6.0/s sent\n"));
}

TEST_F(FleetView, ShowsTheWayToAnAircraftAsOldWhenItIsLost)
{
    Start({"uav1"});
    _roundTripS = 0.0124;
    EXPECT_THAT(Show(NodeState::UP), HasSubstr(", round trip 12 ms, "));
    EXPECT_THAT(Show(NodeState::LOST), HasSubstr(", OLD round trip 12 ms, "));
}

TEST_F(FleetView, ShowsWhatTheCommanderHasSent)
{
    Start({"uav1"});
    auto tally = std::make_shared<Ground::CommandTally>();
    _workspace.AddPublishSubscribeMessage("CommandTally", tally);
    Ground::NodeCommands commands;
    commands.node = "uav1";
    commands.sent = 5;
    commands.acknowledged = 4;
    tally->nodes = {commands};
    tally->PostMessage();
    EXPECT_THAT(Printed(), HasSubstr("commands 5 sent 4 acknowledged"));
}

}  // namespace
