// Orders of a person.
#include "CommanderFixture.h"

namespace
{
using namespace std::chrono_literals;
using CommanderTests::Commander;
using Rabit::Gateway::NodeState;

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

}  // namespace
