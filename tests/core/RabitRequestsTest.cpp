#include "SteppedFixture.h"
#include "TestMessages.h"

#include <rabit/QueueForwarder.h>
#include <rabit/RabitRequests.h>

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

// Stands in for a gateway: keeps the receipt of the last message for another node.
class Forwarder : public QueueForwarder
{
public:
    std::shared_ptr<RabitQueueReceipt> Receipt;

    bool Handles(const std::string &queue) const override { return queue.find('/') != std::string::npos; }
    bool Forward(const std::string &, const std::shared_ptr<RabitMessage> &,
                 const std::shared_ptr<RabitQueueReceipt> &receipt) override
    {
        receipt->Begin();
        Receipt = receipt;
        return true;
    }
};

struct RequestsFixture : SteppedFixture
{
    ScriptedManager &Manager = Add("Manager");
    RabitRequests<NumberMessage> Requests{Manager, 2s, 1};
    std::shared_ptr<Forwarder> Gateway = std::make_shared<Forwarder>();

    RequestsFixture()
    {
        Workspace.SetQueueForwarder(Gateway);
        Reactor.Start();
        RunFor(0s);
    }
    bool Send(const std::string &queue = "uav1/Orders")
    {
        return Requests.Send(queue, std::make_shared<NumberMessage>());
    }
};

TEST(RabitRequests, AReplyEndsTheRequestItAnswers)
{
    RequestsFixture fixture;
    ASSERT_TRUE(fixture.Send());
    ASSERT_TRUE(fixture.Send());
    EXPECT_TRUE(fixture.Requests.TakeEnded().empty());
    const auto reply = std::make_shared<NumberMessage>();
    EXPECT_TRUE(fixture.Requests.Take(2, reply));
    const auto ended = fixture.Requests.TakeEnded();
    ASSERT_EQ(ended.size(), 1u);
    EXPECT_EQ(ended[0].Id, 2u);
    EXPECT_EQ(ended[0].Queue, "uav1/Orders");
    EXPECT_EQ(ended[0].End, RequestEnd::Answered);
    EXPECT_EQ(ended[0].Answer, reply);
    EXPECT_EQ(fixture.Requests.NumberOfOpen(), 1u);
}

TEST(RabitRequests, ARequestWithoutAReplyEndsWhenItsTimeIsOver)
{
    RequestsFixture fixture;
    ASSERT_TRUE(fixture.Send());
    fixture.Gateway->Receipt->Settle(QueueOutcome::Delivered);
    fixture.RunFor(1999ms);
    EXPECT_TRUE(fixture.Requests.TakeEnded().empty());
    fixture.RunFor(1ms);
    const auto ended = fixture.Requests.TakeEnded();
    ASSERT_EQ(ended.size(), 1u);
    EXPECT_EQ(ended[0].End, RequestEnd::NoReply);
    EXPECT_EQ(ended[0].Delivery, QueueOutcome::Delivered);
    EXPECT_EQ(ended[0].Answer, nullptr);
    EXPECT_FALSE(fixture.Requests.Take(1, std::make_shared<NumberMessage>())) << "too late";
}

TEST(RabitRequests, ARequestThatCannotArriveEndsAtOnceAndWakesTheManager)
{
    RequestsFixture fixture;
    ASSERT_TRUE(fixture.Send());
    const int passes = fixture.Manager.Passes;
    fixture.Gateway->Receipt->Settle(QueueOutcome::Expired);
    fixture.RunFor(0s);
    EXPECT_EQ(fixture.Manager.Passes, passes + 1);
    const auto ended = fixture.Requests.TakeEnded();
    ASSERT_EQ(ended.size(), 1u);
    EXPECT_EQ(ended[0].End, RequestEnd::NotDelivered);
    EXPECT_EQ(ended[0].Delivery, QueueOutcome::Expired);
}

TEST(RabitRequests, AReplyOutweighsADoubtfulOrExpiredRequest)
{
    RequestsFixture fixture;
    ASSERT_TRUE(fixture.Send());
    fixture.Gateway->Receipt->Settle(QueueOutcome::InDoubt);
    EXPECT_TRUE(fixture.Requests.TakeEnded().empty()) << "it may have been delivered: a reply may come";
    EXPECT_TRUE(fixture.Requests.Take(1, std::make_shared<NumberMessage>()));
    EXPECT_EQ(fixture.Requests.TakeEnded().at(0).End, RequestEnd::Answered);
}

TEST(RabitRequests, ARefusalAtTheCallLeavesNothingOpen)
{
    RequestsFixture fixture;
    EXPECT_FALSE(fixture.Send("nobody"));
    EXPECT_EQ(fixture.Requests.NextId(), 1u);
    EXPECT_EQ(fixture.Requests.NumberOfOpen(), 0u);
}

TEST(RabitRequests, ALateReplyToAnEarlierRunIsNotTaken)
{
    RequestsFixture fixture;
    RabitRequests<NumberMessage> earlier(fixture.Manager, 2s);
    RabitRequests<NumberMessage> now(fixture.Manager, 2s);
    ASSERT_TRUE(now.Send("uav1/Orders", std::make_shared<NumberMessage>()));
    EXPECT_FALSE(now.Take(earlier.NextId(), std::make_shared<NumberMessage>()));
}

TEST(RabitRequests, ASecondReplyIsNotTaken)
{
    RequestsFixture fixture;
    ASSERT_TRUE(fixture.Send());
    EXPECT_TRUE(fixture.Requests.Take(1, std::make_shared<NumberMessage>()));
    EXPECT_FALSE(fixture.Requests.Take(1, std::make_shared<NumberMessage>()));
    EXPECT_FALSE(fixture.Requests.Take(7, std::make_shared<NumberMessage>()));
    EXPECT_EQ(fixture.Requests.TakeEnded().size(), 1u);
    EXPECT_TRUE(fixture.Requests.TakeEnded().empty());
}

}  // namespace
