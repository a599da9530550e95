#include "Commander.h"

#include <rabit/ManualClock.h>
#include <rabit/QueueForwarder.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/gateway/GatewayManager.h>

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace
{
using namespace std::chrono_literals;
using Rabit::Gateway::NodeState;

class FakeGateway : public Rabit::QueueForwarder
{
public:
    bool Accepts = true;
    std::vector<std::pair<std::string, Uav::Goto>> Sent;
    std::vector<std::pair<std::string, std::shared_ptr<Rabit::RabitMessage>>> All;
    std::vector<std::shared_ptr<Rabit::RabitQueueReceipt>> Receipts;

    bool Handles(const std::string &) const override { return true; }
    bool Forward(const std::string &queue, const std::shared_ptr<Rabit::RabitMessage> &message,
                 const std::shared_ptr<Rabit::RabitQueueReceipt> &receipt) override
    {
        if (!Accepts)
        {
            receipt->Begin();
            receipt->Refuse();
            return false;
        }
        All.emplace_back(queue, message);
        if (const auto *command = dynamic_cast<const Uav::Goto *>(message.get()))
            Sent.emplace_back(queue, *command);
        receipt->Begin();
        Receipts.push_back(receipt);
        return true;
    }
};

// A commander with the aircraft uav1 in its fleet.
class Commander : public testing::Test
{
protected:
    std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace _workspace{_clock};
    std::shared_ptr<FakeGateway> _gateway = std::make_shared<FakeGateway>();
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    Rabit::RabitSteppedReactor _reactor{_workspace};
    Ground::Commander *_commander = nullptr;

    void SetUp() override
    {
        _workspace.SetQueueForwarder(_gateway);
        _workspace.AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
        _workspace.AddPublishSubscribeMessage("uav1/Pose", _pose);
        SetState(NodeState::UP);
    }
    // Without a delay before the first command, unless the test says otherwise.
    void Start(Ground::Commander::Settings settings, std::chrono::milliseconds firstAfter = 0ms)
    {
        settings.FirstAfter = firstAfter;
        auto commander = std::make_unique<Ground::Commander>(std::move(settings), _workspace);
        _commander = commander.get();
        _reactor.AddManager(std::move(commander));
        _reactor.Start();
    }
    void SetState(NodeState state, std::uint64_t incarnation = 1)
    {
        Rabit::Gateway::NodeStatus status;
        status.node = "uav1";
        status.state = state;
        status.incarnation = incarnation;
        _fleet->nodes = {status};
        _fleet->PostMessage();
    }
    // Lets time pass; the aircraft goes on publishing its pose.
    void Run(std::chrono::milliseconds duration)
    {
        for (auto done = 0ms; done < duration; done += 100ms)
        {
            _pose->PostMessage();
            _reactor.RunFor(*_clock, 100ms);
        }
    }
    void Answer(std::uint32_t id, const std::string &node = "uav1")
    {
        auto ack = std::make_shared<Uav::CommandAck>();
        ack->id = id;
        ack->node = node;
        ack->stage = Uav::CommandStage::COMMAND_ACCEPTED;
        ASSERT_TRUE(_workspace.AddMessageToQueue("Commands", ack));
    }
};

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

// A commander that gets orders of a person, and their outcomes.
class OrderedCommander : public Commander
{
protected:
    void SetUp() override
    {
        Commander::SetUp();
        Start({.Node = "ground", .FirstId = 7001});
        Run(100ms);
    }
    void Give(Ground::OrderKind kind)
    {
        auto order = std::make_shared<Ground::Order>();
        order->node = "uav1";
        order->kind = kind;
        order->latitude_deg = 47;
        order->longitude_deg = 8;
        order->altitude_m = 520;
        order->speed_mps = 12;
        ASSERT_TRUE(_workspace.AddMessageToQueue("Commands", order));
        Run(100ms);
    }
    Ground::CommandStatus Last()
    {
        Ground::CommandList list;
        EXPECT_TRUE(_workspace.FetchMessage("CommandList", &list));
        return list.items.empty() ? Ground::CommandStatus{} : list.items.back();
    }
    template <typename T>
    std::shared_ptr<T> TheOneSent()
    {
        EXPECT_EQ(_gateway->All.size(), 1u);
        EXPECT_EQ(_gateway->All.at(0).first, "uav1/MissionControl");
        return std::dynamic_pointer_cast<T>(_gateway->All.at(0).second);
    }
};

TEST_F(OrderedCommander, SendsAnAircraftToAPoint)
{
    Give(Ground::OrderKind::ORDER_GOTO);
    const auto command = TheOneSent<Uav::Goto>();
    ASSERT_TRUE(command);
    EXPECT_EQ(command->id, 7001u);
    EXPECT_EQ(command->reply_to, "ground/Commands");
    EXPECT_EQ(command->latitude_deg, 47);
    EXPECT_EQ(command->longitude_deg, 8);
    EXPECT_EQ(command->altitude_m, 520);
    EXPECT_EQ(command->speed_mps, 12);
}

TEST_F(OrderedCommander, CallsAnAircraftHome)
{
    Give(Ground::OrderKind::ORDER_HOME);
    const auto command = TheOneSent<Uav::GoHome>();
    ASSERT_TRUE(command);
    EXPECT_EQ(command->id, 7001u);
    EXPECT_EQ(command->reply_to, "ground/Commands");
}

TEST_F(OrderedCommander, HasAnAircraftSearch)
{
    Give(Ground::OrderKind::ORDER_SEARCH);
    const auto command = TheOneSent<Uav::Search>();
    ASSERT_TRUE(command);
    EXPECT_EQ(command->id, 7001u);
}

TEST_F(OrderedCommander, ListsWhatBecomesOfTheCommand)
{
    Give(Ground::OrderKind::ORDER_HOME);
    EXPECT_EQ(Last().progress, Ground::CommandProgress::PROGRESS_SENT);
    EXPECT_EQ(Last().node, "uav1");
    EXPECT_EQ(Last().kind, Ground::OrderKind::ORDER_HOME);
    _gateway->Receipts.at(0)->Settle(Rabit::QueueOutcome::Delivered);
    _reactor.RunFor(*_clock, 0ms);
    EXPECT_EQ(Last().progress, Ground::CommandProgress::PROGRESS_DELIVERED);
    Answer(7001);
    _reactor.RunFor(*_clock, 0ms);
    EXPECT_EQ(Last().progress, Ground::CommandProgress::PROGRESS_ACCEPTED);
}

TEST_F(OrderedCommander, ShowsThatACommandExpired)
{
    Give(Ground::OrderKind::ORDER_HOME);
    _gateway->Receipts.at(0)->Settle(Rabit::QueueOutcome::Expired);
    Run(100ms);
    EXPECT_EQ(Last().progress, Ground::CommandProgress::PROGRESS_EXPIRED);
}

TEST_F(OrderedCommander, ShowsAnOrderThatTheGatewayDoesNotTake)
{
    _gateway->Accepts = false;
    Give(Ground::OrderKind::ORDER_HOME);
    EXPECT_EQ(Last().progress, Ground::CommandProgress::PROGRESS_REFUSED);
    Run(1s);
    EXPECT_TRUE(_gateway->All.empty());
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

// Aircraft and areas: uav1 reports the number of its area.
class AreaCommander : public Commander
{
protected:
    void SetUp() override
    {
        Commander::SetUp();
        _workspace.AddPublishSubscribeMessage("uav1/MissionState", _state);
    }
    void Report(std::uint32_t area)
    {
        _state->search_area = area;
        _state->PostMessage();
        Run(200ms);
    }
    void Want(float northM)
    {
        auto area = std::make_shared<Uav::SearchArea>();
        area->north_m = northM;
        ASSERT_TRUE(_workspace.AddMessageToQueue("Commands", area));
        Run(200ms);
    }
    // The number, and its length to the north.
    std::pair<std::uint32_t, float> Posted()
    {
        Uav::SearchArea area;
        _workspace.ForceFetchMessage("SearchArea", &area);
        return area.WasPosted() ? std::pair(area.number, area.north_m) : std::pair(std::uint32_t{0}, 0.0F);
    }
    Ground::AreaList Listed()
    {
        Ground::AreaList list;
        _workspace.ForceFetchMessage("AreaList", &list);
        return list;
    }
    static Ground::Commander::Settings WithArea()
    {
        Ground::Commander::Settings settings;
        settings.Area.emplace().north_m = 100;
        return settings;
    }

    std::shared_ptr<Uav::MissionState> _state = std::make_shared<Uav::MissionState>();
};

TEST_F(AreaCommander, PublishesNoAreaThatNobodyAskedFor)
{
    Start({});
    Run(1s);
    Report(0);
    EXPECT_EQ(Posted().first, 0U);
}

TEST_F(AreaCommander, PublishesTheFirstAreaOnceAnAircraftReportsThatItHasNone)
{
    Start(WithArea());
    Run(5s);
    EXPECT_EQ(Posted().first, 0U) << "the fleet may have one";
    Report(0);
    EXPECT_EQ(Posted(), std::pair(1U, 100.0F));
}

// As after a restart: the first area of the options is an old one by now.
TEST_F(AreaCommander, LeavesAFleetTheAreaThatItHas)
{
    Start(WithArea());
    Report(5);
    Run(5s);
    EXPECT_EQ(Posted().first, 0U);
    Want(321);
    EXPECT_EQ(Posted(), std::pair(6U, 321.0F));
}

TEST_F(AreaCommander, NumbersAWantedAreaAnewIfAnAircraftComesBackWithAHigherNumber)
{
    Start({});
    Want(321);
    EXPECT_EQ(Posted(), std::pair(1U, 321.0F));
    Report(5);
    EXPECT_EQ(Posted(), std::pair(6U, 321.0F));
    Report(6);
    EXPECT_EQ(Posted().first, 6U);
    Want(400);
    EXPECT_EQ(Posted(), std::pair(7U, 400.0F));
}

TEST_F(AreaCommander, ListsAnAreaWithWhatBecomesOfItAtEachAircraft)
{
    Start({});
    Run(200ms);
    Report(0);
    Want(321);
    EXPECT_EQ(Listed().items.at(0).area.number, 1u);
    EXPECT_EQ(Listed().items.at(0).north_m, 321);
    ASSERT_EQ(Listed().items.at(0).answers.size(), 1u);
    EXPECT_EQ(Listed().items[0].answers[0].progress, Ground::AreaProgress::AREA_SENT);
    Report(1);
    EXPECT_EQ(Listed().items[0].answers[0].progress, Ground::AreaProgress::AREA_FLOWN);
    Want(400);
    _state->area_declined = "60 m outside of the geofence";
    Report(1);
    const Ground::AreaList list = Listed();
    ASSERT_EQ(list.items.size(), 2u);
    EXPECT_EQ(list.items[0].answers.at(0).progress, Ground::AreaProgress::AREA_FLOWN);
    EXPECT_EQ(list.items[1].answers.at(0).progress, Ground::AreaProgress::AREA_DECLINED);
    EXPECT_EQ(list.items[1].answers.at(0).reason, "60 m outside of the geofence");
    EXPECT_EQ(list.items[1].answers.at(0).flies, 1u);
}

TEST_F(AreaCommander, CountsNoReplayAmongTheAircraft)
{
    Start({});
    _fleet->nodes[0].replay = true;
    _fleet->PostMessage();
    Run(200ms);
    Report(4);
    Want(321);
    EXPECT_TRUE(Listed().items.at(0).answers.empty());
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

// A commander of a searcher that a person has given an order.
class CommanderOfAnOrderedSearcher : public Commander
{
protected:
    void SetUp() override
    {
        Commander::SetUp();
        Start({.Searchers = {"*"}});
        Run(1s);
        ASSERT_EQ(_gateway->All.size(), 1u) << "it was told to search";
        Order();
        ASSERT_EQ(_gateway->All.size(), 2u) << "it was called home";
    }
    void Order()
    {
        auto order = std::make_shared<Ground::Order>();
        order->node = "uav1";
        order->kind = Ground::OrderKind::ORDER_HOME;
        ASSERT_TRUE(_workspace.AddMessageToQueue("Commands", order));
        Run(100ms);
    }
    bool IsWithoutOrders()
    {
        Ground::CommandTally tally;
        _workspace.ForceFetchMessage("CommandTally", &tally);
        return tally.nodes.at(0).without_orders;
    }
};

TEST_F(CommanderOfAnOrderedSearcher, DoesNotSendItSearchingWhenItHasRestarted)
{
    SetState(NodeState::LOST);
    Run(5s);
    SetState(NodeState::UP, 2);
    Run(30s);
    EXPECT_EQ(_gateway->All.size(), 2u);
}

TEST_F(CommanderOfAnOrderedSearcher, TellsThatItIsBackWithoutOrdersUntilItHasSome)
{
    EXPECT_FALSE(IsWithoutOrders());
    SetState(NodeState::UP, 2);
    Run(1s);
    EXPECT_TRUE(IsWithoutOrders());
    Order();
    EXPECT_FALSE(IsWithoutOrders());
}

TEST_F(CommanderOfAnOrderedSearcher, EndsTheCommandsOfItsEarlierLife)
{
    Answer(2);
    Run(1s);
    SetState(NodeState::UP, 2);
    Run(1s);
    EXPECT_EQ(_commander->Log().Commands().at(1).progress, Ground::CommandProgress::PROGRESS_REPLACED);
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
