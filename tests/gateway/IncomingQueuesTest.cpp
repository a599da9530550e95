#include "queues/IncomingQueues.h"

#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <vector>

#include "names/TypeDefinition.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

LinkDelivery DeliveryOf(std::string_view source, const std::vector<std::uint8_t> &payload)
{
    return {
        .Source = source, .Queue = "Orders", .Type = LinkTypeName(Uav::Goto::IdlType()), .Payload = payload};
}

std::vector<std::uint8_t> GotoBytes(std::uint32_t id)
{
    Uav::Goto message;
    message.id = id;
    const MessageType &type = *MessageTypeRegistry::Of(message);
    std::vector<std::uint8_t> bytes(type.SerializedSize(message));
    type.Serialize(message, bytes);
    return bytes;
}

class IncomingQueuesTest : public ::testing::Test
{
protected:
    IncomingQueuesTest() : incoming(Rules(), workspace, [] {})
    {
        workspace.AddManagerMessageQueue("Orders", local);
        incoming.Find([](const std::string &) {});
        for (std::uint32_t id = 1; id <= 3; ++id)
        {
            payloads.push_back(GotoBytes(id));
        }
    }

    static std::vector<AcceptRule> Rules() { return {{.Queue = "Orders", .Types = {"Uav::Goto"}}}; }

    LocalQueueResult Deliver(std::size_t item)
    {
        return incoming.Deliver(DeliveryOf("uav1", payloads[item]));
    }

    std::uint32_t Take()
    {
        std::shared_ptr<RabitMessage> message;
        return local->GetMessage(message) ? std::dynamic_pointer_cast<Uav::Goto>(message)->id : 0;
    }

    RabitWorkspace workspace;
    std::shared_ptr<IncomingQueues::Queue> local = std::make_shared<IncomingQueues::Queue>(10, "Orders");
    IncomingQueues incoming;
    std::vector<std::vector<std::uint8_t>> payloads;
};

TEST_F(IncomingQueuesTest, ASenderToAQueueThatAcceptsNothingOfItIsNamedForSomeSeconds)
{
    const auto clock = std::make_shared<ManualClock>(1.4e9, std::chrono::seconds(1000));
    RabitWorkspace stepped(clock);
    std::vector<AcceptRule> rules = Rules();
    rules[0].From = {"ground"};
    IncomingQueues strict(rules, stepped, [] {});
    EXPECT_TRUE(strict.Accepts("ground", "Orders"));
    EXPECT_TRUE(strict.Problems().empty() || strict.Problems()[0].node.empty());
    EXPECT_FALSE(strict.Accepts("uav2", "Orders"));
    ASSERT_FALSE(strict.Problems().empty());
    EXPECT_EQ(strict.Problems()[0].subject, "accept Orders");
    EXPECT_EQ(strict.Problems()[0].node, "uav2");
    EXPECT_EQ(strict.Problems()[0].reason,
              "uav2 sends messages to queue `Orders`, which accepts none of it: they are refused");
    clock->Advance(RecentProblems::Memory);
    EXPECT_TRUE(strict.Problems()[0].node.empty());
}

TEST_F(IncomingQueuesTest, ASenderToAQueueThatThereIsNotIsNamed)
{
    EXPECT_FALSE(incoming.Accepts("uav2", "Nowhere"));
    ASSERT_EQ(incoming.Problems().size(), 1u);
    EXPECT_EQ(incoming.Problems()[0].subject, "accept Nowhere");
}

TEST_F(IncomingQueuesTest, AcceptsTheTypesOfTheQueueAlone)
{
    EXPECT_TRUE(incoming.AcceptsType("Orders", LinkTypeName(Uav::Goto::IdlType())));
    EXPECT_FALSE(incoming.AcceptsType("Orders", LinkTypeName(Uav::Pose::IdlType())));
    EXPECT_FALSE(incoming.AcceptsType("Nowhere", LinkTypeName(Uav::Goto::IdlType())));
}

// A recorder is told the plain name of the type.
TEST_F(IncomingQueuesTest, AcceptsOneDefinitionOfATypeAlone)
{
    IncomingQueues told(
        Rules(), workspace, [] {}, IncomingQueues::QuicklyDecoded, true);
    told.Find([](const std::string &) {});
    LinkDelivery delivery = DeliveryOf("uav1", payloads[0]);
    EXPECT_EQ(told.Deliver(delivery), LocalQueueResult::Ok);
    std::string other(delivery.Type);
    other.back() = other.back() == '0' ? '1' : '0';
    delivery.Type = other;
    EXPECT_FALSE(told.AcceptsType("Orders", other));
    EXPECT_EQ(told.Deliver(delivery), LocalQueueResult::WrongType);
    delivery.Type = "Uav::Goto";
    EXPECT_EQ(told.Deliver(delivery), LocalQueueResult::WrongType);
    EXPECT_EQ(Take(), 1u);
    EXPECT_EQ(Take(), 0u);
    std::vector<IncomingQueues::Received> received;
    told.TakeReceived(received);
    ASSERT_EQ(received.size(), 1u);
    EXPECT_EQ(received[0].Type, "Uav::Goto");
}

// A fixture in which all messages are large.
class LargeMessagesTest : public IncomingQueuesTest
{
protected:
    LargeMessagesTest()
        : large(
              Rules(), workspace, [] {}, 0)
    {
        large.Find([](const std::string &) {});
    }

    LocalQueueResult Deliver(std::size_t item, std::shared_ptr<void> prepared = nullptr)
    {
        LinkDelivery delivery = DeliveryOf("uav1", payloads[item]);
        delivery.SenderLife = 7;
        delivery.Number = item + 1;
        delivery.Prepared = std::move(prepared);
        return large.Deliver(delivery);
    }
    std::vector<IncomingQueues::Undecoded> PutOff()
    {
        std::vector<IncomingQueues::Undecoded> messages;
        large.TakeUndecoded(messages);
        return messages;
    }

    IncomingQueues large;
};

TEST_F(LargeMessagesTest, AreDeliveredOnceTheyAreDecoded)
{
    EXPECT_EQ(Deliver(0), LocalQueueResult::Later);
    EXPECT_EQ(Take(), 0u);
    const auto messages = PutOff();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_FALSE(large.AnyUndecoded());
    EXPECT_EQ(Deliver(0, large.Decode(messages[0])), LocalQueueResult::Ok);
    EXPECT_EQ(Take(), 1u);
}

TEST_F(LargeMessagesTest, AreGivenOutWithWhatNamesThem)
{
    Deliver(1);
    const auto messages = PutOff();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages[0].Source, "uav1");
    EXPECT_EQ(messages[0].Queue, "Orders");
    EXPECT_EQ(messages[0].SenderLife, 7u);
    EXPECT_EQ(messages[0].Number, 2u);
}

TEST_F(LargeMessagesTest, AreNotDecodedForAFullQueue)
{
    for (int i = 0; i < 10; ++i)
    {
        incoming.Deliver(DeliveryOf("uav1", payloads[0]));
    }
    EXPECT_EQ(Deliver(0), LocalQueueResult::Full);
    EXPECT_FALSE(large.AnyUndecoded());
}

// It would hold up those behind it.
TEST_F(LargeMessagesTest, OfAnotherDefinitionAreRefusedEvenIfTheQueueIsFull)
{
    for (int i = 0; i < 10; ++i)
    {
        incoming.Deliver(DeliveryOf("uav1", payloads[0]));
    }
    LinkDelivery delivery = DeliveryOf("uav1", payloads[0]);
    delivery.Type = "Uav::Goto@0";
    EXPECT_EQ(large.Deliver(delivery), LocalQueueResult::WrongType);
}

TEST_F(LargeMessagesTest, ThatDoNotDecodeAreRefused)
{
    payloads[0].resize(5);
    EXPECT_EQ(Deliver(0), LocalQueueResult::Later);
    EXPECT_EQ(Deliver(0, large.Decode(PutOff().at(0))), LocalQueueResult::Undecodable);
}

TEST_F(IncomingQueuesTest, NamesEachQueueThatGotMessagesOnce)
{
    Deliver(0);
    Deliver(1);
    std::vector<std::shared_ptr<IncomingQueues::Queue>> queues;
    incoming.TakeDelivered(queues);
    EXPECT_EQ(queues, std::vector{local});
    EXPECT_FALSE(incoming.AnyDelivered());
}

}  // namespace
}  // namespace Rabit
