// Several forwarders in one workspace, and which of them gets a message. RabitWorkspaceTest has the rules
// for one.
#include "TestMessages.h"

#include <rabit/QueueForwarder.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/RabitWorkspace.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace Rabit
{
namespace
{
using RabitTest::NumberMessage;
using testing::ElementsAre;
using testing::IsEmpty;

// Handles "node/queue", knows some of the nodes, and delivers at once. "*" means all nodes that it knows.
class Network : public QueueForwarder
{
public:
    explicit Network(std::set<std::string> nodes) : Nodes(std::move(nodes)) {}

    bool Handles(const std::string &name) const override { return name.find('/') != std::string::npos; }
    std::vector<std::string> Known(const std::string &name, const RabitMessage &) const override
    {
        const std::string node = name.substr(0, name.find('/'));
        std::vector<std::string> known;
        for (const std::string &one : Nodes)
        {
            if (node == "*" || node == one)
            {
                known.push_back(one + name.substr(name.find('/')));
            }
        }
        return known;
    }
    bool Forward(const std::string &name, const std::shared_ptr<RabitMessage> &message,
                 const std::shared_ptr<RabitQueueReceipt> &receipt) override
    {
        Got.push_back(name);
        const std::size_t queues = Known(name, *message).size();
        if (receipt)
        {
            receipt->Begin(static_cast<std::uint32_t>(std::max<std::size_t>(queues, 1)));
            for (std::size_t i = 0; i < queues; ++i)
            {
                receipt->Settle(QueueOutcome::Delivered);
            }
            if (queues == 0)
            {
                receipt->Refuse();
            }
        }
        return queues > 0;
    }
    void TakenElsewhere(const std::string &name) override { Elsewhere.push_back(name); }

    const std::set<std::string> Nodes;
    std::vector<std::string> Got;
    std::vector<std::string> Elsewhere;
};

class QueueForwarders : public testing::Test
{
protected:
    QueueForwarders()
    {
        EXPECT_TRUE(workspace.AddQueueForwarder("Radio", radio));
        EXPECT_TRUE(workspace.AddQueueForwarder("Lan", lan));
    }
    bool Send(const std::string &name)
    {
        receipt = std::make_shared<RabitQueueReceipt>();
        known = 0;
        connection = receipt->ConnectOutcomeKnown([this] { ++known; });
        return workspace.AddMessageToQueue(name, std::make_shared<NumberMessage>(), receipt);
    }

    RabitWorkspace workspace;
    const std::shared_ptr<Network> radio = std::make_shared<Network>(std::set<std::string>{"both", "uav1"});
    const std::shared_ptr<Network> lan = std::make_shared<Network>(std::set<std::string>{"both", "vision"});
    std::shared_ptr<RabitQueueReceipt> receipt;
    RabitConnection connection;
    int known = 0;
};

TEST_F(QueueForwarders, TheOneThatKnowsTheQueueGetsTheMessage)
{
    EXPECT_TRUE(Send("vision/Q"));
    EXPECT_TRUE(Send("uav1/Q"));
    EXPECT_THAT(radio->Got, ElementsAre("uav1/Q"));
    EXPECT_THAT(lan->Got, ElementsAre("vision/Q"));
    EXPECT_THAT(radio->Elsewhere, ElementsAre("vision/Q"));
}

TEST_F(QueueForwarders, OfSeveralThatKnowItTheFirstGetsIt)
{
    EXPECT_TRUE(Send("both/Q"));
    EXPECT_THAT(radio->Got, ElementsAre("both/Q"));
    EXPECT_THAT(lan->Got, IsEmpty());
}

TEST_F(QueueForwarders, ExactlyOneRefusesWhatNoneKnows)
{
    EXPECT_FALSE(Send("nobody/Q"));
    EXPECT_THAT(radio->Got, ElementsAre("nobody/Q"));
    EXPECT_THAT(lan->Got, IsEmpty());
    EXPECT_EQ(receipt->GetCounts().Refused, 1u);
}

TEST_F(QueueForwarders, ANameForManyGoesToEachQueueOnce)
{
    EXPECT_TRUE(Send("*/Q"));
    EXPECT_THAT(radio->Got, ElementsAre("both/Q", "uav1/Q"));
    EXPECT_THAT(lan->Got, ElementsAre("vision/Q"));
    EXPECT_EQ(receipt->GetCounts().Delivered, 3u);
}

TEST_F(QueueForwarders, AReceiptForManyIsKnownOnceWhenAllAre)
{
    EXPECT_TRUE(Send("*/Q"));
    EXPECT_EQ(known, 1);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Delivered);
}

TEST_F(QueueForwarders, OneThatEndsLeavesTheOthersAtWork)
{
    workspace.RemoveQueueForwarder("Radio");
    EXPECT_TRUE(Send("both/Q"));
    EXPECT_TRUE(Send("vision/Q"));
    EXPECT_FALSE(Send("uav1/Q"));
    EXPECT_THAT(lan->Got, ElementsAre("both/Q", "vision/Q", "uav1/Q"));
    EXPECT_THAT(radio->Got, IsEmpty());
    workspace.RemoveQueueForwarder("Lan");
    EXPECT_FALSE(Send("vision/Q"));
    EXPECT_EQ(lan->Got.size(), 3u);
}

TEST_F(QueueForwarders, HaveNamesOfTheirOwn)
{
    EXPECT_FALSE(workspace.AddQueueForwarder("Radio", std::make_shared<Network>(std::set<std::string>{"x"})));
    EXPECT_FALSE(Send("x/Q"));
    EXPECT_THAT(workspace.GetListOfQueueForwarders(), ElementsAre("Radio", "Lan"));
    workspace.RemoveQueueForwarder("Radio");
    EXPECT_TRUE(workspace.AddQueueForwarder("Radio", std::make_shared<Network>(std::set<std::string>{"x"})));
    EXPECT_TRUE(Send("x/Q"));
    EXPECT_THAT(workspace.GetListOfQueueForwarders(), ElementsAre("Lan", "Radio"));
    EXPECT_THROW(workspace.AddQueueForwarder("None", nullptr), std::invalid_argument);
}

TEST_F(QueueForwarders, TheOneThatIsSetStandsBesideThoseThatAreAdded)
{
    const auto set = std::make_shared<Network>(std::set<std::string>{"x"});
    workspace.SetQueueForwarder(set);
    EXPECT_TRUE(Send("x/Q"));
    EXPECT_TRUE(Send("vision/Q"));
    workspace.SetQueueForwarder(nullptr);
    EXPECT_FALSE(Send("x/Q"));
    EXPECT_TRUE(Send("vision/Q"));
}

TEST_F(QueueForwarders, MayComeAndGoWhileMessagesAreSent)
{
    std::atomic<bool> end{false};
    std::thread sending(
        [&]
        {
            while (!end)
            {
                workspace.AddMessageToQueue("vision/Q", std::make_shared<NumberMessage>());
                workspace.AddMessageToQueue("*/Q", std::make_shared<NumberMessage>());
            }
        });
    for (int i = 0; i < 200; ++i)
    {
        const auto coming = std::make_shared<Network>(std::set<std::string>{"x"});
        ASSERT_TRUE(workspace.AddQueueForwarder("Coming", coming));
        workspace.RemoveQueueForwarder("Coming");
        coming->Got.clear();  // nobody uses it any more
    }
    end = true;
    sending.join();
    EXPECT_THAT(workspace.GetListOfQueueForwarders(), ElementsAre("Radio", "Lan"));
}

}  // namespace
}  // namespace Rabit
