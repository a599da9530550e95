// The samples that a gateway writes to a topic of programs that are no nodes.
#include "foreign/ForeignPublisher.h"

#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>

#include "ForeignNetwork.h"
#include "keyed.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using GatewayTest::Contact;

class ForeignPublisherTest : public testing::Test
{
protected:
    ForeignPublisherTest()
    {
        rule.Way = ForeignRule::Direction::Publish;
        rule.Topic = "contacts";
        rule.Type = "GatewayTest::Contact";
        rule.Local = "Contact";
        rule.Names = ForeignRule::WireNames::Ros2;
        workspace.AddPublishSubscribeMessage("Contact", local);
        network.Endpoints = {{.Topic = "rt/contacts", .Type = "GatewayTest::dds_::Contact_"}};
    }

    ForeignPublisher &Publisher()
    {
        if (!publisher)
        {
            publisher = std::make_unique<ForeignPublisher>(rule, type, ForeignMatch::Network{7}, workspace,
                                                           source, session, AirCost(1400));
            workspace.AddPublishSubscribeMessage("Contact", publisher->Local());
            publisher->SetAttached();
        }
        return *publisher;
    }
    void Post(std::uint32_t id)
    {
        local->number = id;
        local->PostMessage();
    }
    std::chrono::nanoseconds Service()
    {
        const std::chrono::nanoseconds look = Publisher().Service(clock->Monotonic());
        return std::min(look, Publisher().WriteDue(clock->Monotonic()));
    }

    std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>(1.4e9, 100s);
    RabitWorkspace workspace{clock};
    const SourceClock source{*clock};
    const MessageType &type = *MessageTypeRegistry::Find("GatewayTest::Contact");
    std::shared_ptr<Contact> local = std::make_shared<Contact>();
    Foreign::Network network;
    Foreign::Session session{network};
    ForeignRule rule;
    std::unique_ptr<ForeignPublisher> publisher;
};

TEST_F(ForeignPublisherTest, WritesUnderTheNamesOfTheWire)
{
    Publisher();
    EXPECT_EQ(network.Topic.Name, "rt/contacts");
    EXPECT_EQ(network.Topic.TypeName, "GatewayTest::dds_::Contact_");
    EXPECT_EQ(network.WriterQos.Reliability, Reliability::Reliable);
    EXPECT_EQ(network.WriterQos.Durability, Durability::Volatile);
    EXPECT_EQ(network.WriterQos.Depth, 10);
}

TEST_F(ForeignPublisherTest, WritesEachPostOnce)
{
    Publisher();
    Service();
    EXPECT_TRUE(network.Written.empty());
    Post(3);
    Service();
    Service();
    ASSERT_EQ(network.Written.size(), 1u);
    Contact written;
    ASSERT_TRUE(type.Deserialize(network.Written[0], written));
    EXPECT_EQ(written.number, 3u);
    EXPECT_EQ(Publisher().Status().samples, 1u);
    EXPECT_EQ(Publisher().Status().readers, 1u);
}

TEST_F(ForeignPublisherTest, WritesNoMoreOftenThanTheRuleAllows)
{
    rule.MaxRate = 10;
    Publisher();
    Post(3);
    Service();
    Post(4);
    EXPECT_EQ(Service(), clock->Monotonic() + 100ms);
    EXPECT_EQ(network.Written.size(), 1u);
    clock->Advance(100ms);
    Service();
    EXPECT_EQ(network.Written.size(), 2u);
}

TEST_F(ForeignPublisherTest, TheLowestRateWritesOnceAYear)
{
    rule.MaxRate = 1e-300;
    Publisher();
    Post(3);
    Service();
    Post(4);
    clock->Advance(24h * 365 - 1s);
    Service();
    EXPECT_EQ(network.Written.size(), 1u);
    clock->Advance(1s);
    Service();
    EXPECT_EQ(network.Written.size(), 2u);
}

TEST_F(ForeignPublisherTest, TriesAgainWhatTheNetworkDidNotTake)
{
    Publisher();
    network.Result = WriteResult::TimedOut;
    Post(3);
    EXPECT_EQ(Service(), clock->Monotonic() + ForeignPublisher::RetryGap);
    network.Result = WriteResult::Ok;
    clock->Advance(ForeignPublisher::RetryGap);
    Service();
    EXPECT_EQ(network.Written.size(), 1u);
    EXPECT_EQ(Publisher().Status().write_failures, 1u);
}

TEST_F(ForeignPublisherTest, CountsThePostsThatWereReplacedBeforeTheyWereWritten)
{
    rule.MaxRate = 10;
    Publisher();
    Post(1);
    Post(2);
    Service();
    EXPECT_EQ(Publisher().Status().replaced, 1u);
    Post(3);
    Service();
    Post(4);
    Service();
    EXPECT_EQ(Publisher().Status().replaced, 2u);
    clock->Advance(100ms);
    Service();
    EXPECT_EQ(Publisher().Status().samples, 2u);
    EXPECT_EQ(Publisher().Status().replaced, 2u);
}

TEST_F(ForeignPublisherTest, WaitsForTheTurnThatAScheduleGivesItAndWritesTheNewestValueThen)
{
    Publisher();
    EXPECT_EQ(Publisher().DueAt(clock->Monotonic()), std::chrono::nanoseconds::max());
    Post(1);
    Publisher().Fetch();
    EXPECT_EQ(Publisher().DueAt(clock->Monotonic()), clock->Monotonic());
    EXPECT_EQ(Publisher().NextBytes(), AirCost(1400).Of(type.SerializedSize(*local) - 4));
    Post(2);
    Publisher().Fetch();
    EXPECT_EQ(Publisher().SentBytes(), 0u);
    Publisher().WriteNext(clock->Monotonic());
    ASSERT_EQ(network.Written.size(), 1u);
    Contact written;
    ASSERT_TRUE(type.Deserialize(network.Written[0], written));
    EXPECT_EQ(written.number, 2u);
    EXPECT_EQ(Publisher().SentBytes(), AirCost(1400).Of(type.SerializedSize(*local) - 4));
    EXPECT_EQ(Publisher().DueAt(clock->Monotonic()), std::chrono::nanoseconds::max());
}

TEST_F(ForeignPublisherTest, DisposesOfTheFormerInstanceWhenTheKeyChanges)
{
    Publisher();
    Post(3);
    Service();
    Post(4);
    Service();
    EXPECT_EQ(network.Disposals, 1);
}

TEST_F(ForeignPublisherTest, SaysWhyNothingGoesAndThatAnotherTypeIsAProblem)
{
    network.Endpoints.clear();
    Publisher();
    Service();
    EXPECT_EQ(Publisher().Status().reason, "no program reads `rt/contacts` in domain 7");
    EXPECT_FALSE(Publisher().Problem(clock->Monotonic()));
    network.Endpoints = {{.Topic = "rt/contacts", .Type = "GatewayTest::Contact"}};
    clock->Advance(ForeignPublisher::LookPeriod);
    Service();
    ASSERT_TRUE(Publisher().Problem(clock->Monotonic()));
    EXPECT_EQ(Publisher().Problem(clock->Monotonic())->reason,
              "a program reads `rt/contacts` as `GatewayTest::Contact`, this node writes it as "
              "`GatewayTest::dds_::Contact_`");
    EXPECT_TRUE(Publisher().TakeChange());
}

TEST_F(ForeignPublisherTest, AReaderThatGetsNothingStaysAProblemWhenAnotherOneMatches)
{
    const RemoteEndpoint matching = network.Endpoints.front();
    RemoteEndpoint asking = matching;
    asking.Reliability = Reliability::Reliable;
    asking.Durability = Durability::TransientLocal;
    network.Endpoints = {asking};
    Publisher();
    Service();
    const auto before = Publisher().Problem(clock->Monotonic());
    ASSERT_TRUE(before);
    network.Endpoints = {asking, matching};
    clock->Advance(ForeignPublisher::LookPeriod);
    Service();
    ASSERT_TRUE(Publisher().Problem(clock->Monotonic()));
    EXPECT_EQ(Publisher().Problem(clock->Monotonic())->reason, before->reason);
    network.Endpoints = {matching};
    clock->Advance(ForeignPublisher::LookPeriod);
    Service();
    EXPECT_FALSE(Publisher().Problem(clock->Monotonic()));
}

}  // namespace
}  // namespace Rabit
