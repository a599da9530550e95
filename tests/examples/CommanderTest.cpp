// Commands by settings, and the end of a run.
#include "CommanderFixture.h"

namespace
{
using namespace std::chrono_literals;
using CommanderTests::Commander;
using Rabit::Gateway::NodeState;

TEST_F(Commander, SendsACommandEachPeriodToTheQueueOfTheAircraft)
{
    Start({.Node = "ground", .Period = 5s});
    Run(12s);
    ASSERT_EQ(_gateway->Sent.size(), 3u);
    for (std::uint32_t i = 0; i < 3; ++i)
    {
        EXPECT_EQ(_gateway->Sent[i].first, "uav1/MissionControl");
        EXPECT_EQ(_gateway->Sent[i].second.id, i + 1);
        EXPECT_EQ(_gateway->Sent[i].second.reply_to, "ground/Commands");
    }
    EXPECT_EQ(_commander->Log().Of("uav1").Sent, 3u);
}

TEST_F(Commander, LetsAnAircraftFlyByItselfBeforeTheFirstCommand)
{
    Start({.Period = 15s}, 2s);
    Run(1900ms);
    EXPECT_TRUE(_gateway->Sent.empty());
    Run(200ms);
    EXPECT_EQ(_gateway->Sent.size(), 1u);
}

TEST_F(Commander, WaitsLessForTheFirstCommandInAShortRun)
{
    Start({.Period = 15s, .Duration = 4s}, 2s);
    Run(1s);
    EXPECT_EQ(_gateway->Sent.size(), 1u);
}

TEST_F(Commander, SendsNothingToAnAircraftThatIsNotUp)
{
    SetState(NodeState::STALE);
    Start({.Period = 15s});
    Run(2s);
    SetState(NodeState::LOST);
    Run(2s);
    EXPECT_TRUE(_gateway->Sent.empty());
}

TEST_F(Commander, SendsNothingToANodeWithoutAPose)
{
    Start({.Period = 15s});
    _reactor.RunFor(*_clock, 5s);
    EXPECT_TRUE(_gateway->Sent.empty());
}

TEST_F(Commander, SendsNothingOnTheStrengthOfAnOldPose)
{
    _pose->PostMessage();
    _clock->Advance(2s);
    Start({.Period = 15s});
    _reactor.RunFor(*_clock, 5s);
    EXPECT_TRUE(_gateway->Sent.empty());
}

TEST_F(Commander, TriesARefusedCommandAgainWithTheSameNumber)
{
    _gateway->Accepts = false;
    Start({.Period = 15s});
    Run(500ms);
    EXPECT_GT(_commander->Log().Of("uav1").Refused, 0u);
    _gateway->Accepts = true;
    Run(500ms);
    ASSERT_EQ(_gateway->Sent.size(), 1u);
    EXPECT_EQ(_gateway->Sent[0].second.id, 1u);
}

TEST_F(Commander, TriesARefusedCommandAgainWithItsPeriodHoweverOftenItIsWoken)
{
    _gateway->Accepts = false;
    Start({.Period = 15s});
    Run(100ms);
    const std::uint64_t before = _commander->Log().Of("uav1").Refused;
    for (int i = 0; i < 50; ++i)
    {
        _commander->WakeUpManagerEH();
        _reactor.RunFor(*_clock, 0ms);
    }
    EXPECT_EQ(_commander->Log().Of("uav1").Refused, before);
    Run(1s);
    EXPECT_EQ(_commander->Log().Of("uav1").Refused, before + 10);
}

TEST_F(Commander, BooksAnswersAndPublishesTheTally)
{
    Start({.Period = 15s});
    Run(1s);
    Answer(1);
    Run(100ms);
    Ground::CommandTally tally;
    ASSERT_TRUE(_workspace.FetchMessage("CommandTally", &tally));
    ASSERT_EQ(tally.nodes.size(), 1u);
    EXPECT_EQ(tally.nodes[0].node, "uav1");
    EXPECT_EQ(tally.nodes[0].sent, 1u);
    EXPECT_EQ(tally.nodes[0].acknowledged, 1u);
}

TEST_F(Commander, StopsSendingBeforeTheEndAndEndsOnTime)
{
    Start({.Period = 1s, .Duration = 10s, .Quiet = 3s});
    for (std::uint32_t id = 1; id <= 7; ++id)
    {
        Run(1s);
        Answer(id);
    }
    Run(2900ms);
    EXPECT_EQ(_gateway->Sent.size(), 7u);
    EXPECT_TRUE(_reactor.IsRunning());
    Run(200ms);
    EXPECT_FALSE(_reactor.IsRunning());
    EXPECT_TRUE(_commander->Log().Outstanding().empty());
}

TEST_F(Commander, WaitsAtTheEndForAnswersThatAreStillOut)
{
    Start({.Period = 5s, .Duration = 10s, .Quiet = 3s});
    Run(11s);
    EXPECT_TRUE(_reactor.IsRunning());
    Answer(1);
    Answer(2);
    Run(200ms);
    EXPECT_FALSE(_reactor.IsRunning());
}

TEST_F(Commander, DoesNotWaitForEver)
{
    Start({.Period = 5s, .Duration = 10s, .Quiet = 3s});
    Run(13s + 200ms);
    EXPECT_FALSE(_reactor.IsRunning());
    EXPECT_FALSE(_commander->Log().Outstanding().empty());
}

TEST_F(Commander, EndsWhenAskedToOnceTheAnswersAreThere)
{
    Start({.Period = 1s});
    Run(500ms);
    _commander->RequestEnd();
    Run(2s);
    EXPECT_EQ(_gateway->Sent.size(), 1u);
    EXPECT_TRUE(_reactor.IsRunning());
    Answer(1);
    Run(100ms);
    EXPECT_FALSE(_reactor.IsRunning());
}

TEST_F(Commander, SendsForHalfOfAShortRun)
{
    Start({.Period = 500ms, .Duration = 2s, .Quiet = 3s});
    Run(2s);
    EXPECT_EQ(_gateway->Sent.size(), 2u);
}

TEST_F(Commander, PublishesItsGeofenceAlsoIfThereIsNone)
{
    Uav::Geofence fence;
    fence.radius_m = 7;
    Start({});
    ASSERT_TRUE(_workspace.FetchMessage("Geofence", &fence));
    EXPECT_TRUE(fence.WasPosted());
    EXPECT_EQ(fence.radius_m, 0);
}

TEST_F(Commander, SendsNoGotoNearAPositionThatCannotBe)
{
    _pose->latitude_deg = 1e300;
    Start({.Period = 5s});
    Run(2s);
    EXPECT_TRUE(_gateway->Sent.empty());
}

TEST_F(Commander, TellsASearcherToSearchOnce)
{
    Start({.Searchers = {"uav1"}});
    Run(5s);
    ASSERT_EQ(_gateway->All.size(), 1u);
    EXPECT_TRUE(std::dynamic_pointer_cast<Uav::Search>(_gateway->All[0].second));
}

TEST_F(Commander, TellsAllToSearchByAnAsterisk)
{
    Start({.Searchers = {"*"}});
    Run(5s);
    EXPECT_EQ(_gateway->All.size(), 1u);
}

TEST_F(Commander, TellsASearcherAgainWhenItHasRestarted)
{
    Start({.Searchers = {"uav1"}});
    Run(1s);
    SetState(NodeState::UP, 2);
    Run(1s);
    EXPECT_EQ(_gateway->All.size(), 2u);
}

TEST_F(Commander, TellsNobodyIsWithoutOrdersWhomNobodyCommanded)
{
    Start({.Searchers = {"*"}});
    Run(1s);
    SetState(NodeState::UP, 2);
    Run(1s);
    Ground::CommandTally tally;
    ASSERT_TRUE(_workspace.FetchMessage("CommandTally", &tally));
    EXPECT_FALSE(tally.nodes.at(0).without_orders);
}

TEST_F(Commander, TellsByWhichNumbersPeopleKnowItsCommands)
{
    Start({.FirstId = 7001, .Searchers = {"*"}});
    Run(1s);
    Ground::CommandTally tally;
    ASSERT_TRUE(_workspace.FetchMessage("CommandTally", &tally));
    EXPECT_EQ(tally.first_id, 7001u);
    EXPECT_EQ(tally.commands, 1u);
}

TEST_F(Commander, SendsNothingByItselfUnlessItsSettingsSaySo)
{
    Start({});
    Run(30s);
    EXPECT_TRUE(_gateway->All.empty());
}

}  // namespace
