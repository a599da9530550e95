#include "queues/IncomingQueues.h"

#include <gtest/gtest.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <vector>

#include "uav.idl.h"

namespace Rabit
{
namespace
{

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
        data.Queue = "Orders";
        for (const auto &payload : payloads)
        {
            data.Items.push_back({.Type = "Uav::Goto", .Payload = payload});
        }
    }

    static std::vector<AcceptRule> Rules() { return {{.Queue = "Orders", .Types = {"Uav::Goto"}}}; }

    LocalQueueResult Deliver(std::size_t item)
    {
        return incoming.Deliver("uav1", "Orders", "Uav::Goto", payloads[item], false);
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
    LinkData data;
};

TEST_F(IncomingQueuesTest, DeliversTheMessageThatWasDecodedFromThePayload)
{
    IncomingQueues::DecodedMessages messages;
    incoming.Decode(data, messages);
    ASSERT_EQ(messages.size(), 3u);
    incoming.Offer(messages);
    // The first two were consumed before, so the links pass over them.
    EXPECT_EQ(Deliver(2), LocalQueueResult::Ok);
    EXPECT_EQ(Take(), 3u);
    EXPECT_EQ(messages[2].What.Message.use_count(), 1);
}

TEST_F(IncomingQueuesTest, DecodesWhatWasNotOffered)
{
    incoming.Offer({});
    EXPECT_EQ(Deliver(1), LocalQueueResult::Ok);
    EXPECT_EQ(Take(), 2u);
}

TEST_F(IncomingQueuesTest, DecodesNothingOfWhatIsSkippedOrForAQueueThatIsNotAccepted)
{
    data.Items[1].Flags = LinkFlagSkip;
    IncomingQueues::DecodedMessages messages;
    incoming.Decode(data, messages);
    EXPECT_EQ(messages.size(), 2u);
    messages.clear();
    data.Queue = "Others";
    incoming.Decode(data, messages);
    EXPECT_TRUE(messages.empty());
}

TEST_F(IncomingQueuesTest, TakesNothingOfANodeThatIsNotInFrom)
{
    IncomingQueues choosy({{.Queue = "Orders", .Types = {"Uav::Goto"}, .From = {"ground*"}}}, workspace,
                          [] {});
    choosy.Find([](const std::string &) {});
    EXPECT_EQ(choosy.Deliver("uav1", "Orders", "Uav::Goto", payloads[0], false), LocalQueueResult::Unknown);
    EXPECT_EQ(Take(), 0u);
    EXPECT_EQ(choosy.Deliver("ground2", "Orders", "Uav::Goto", payloads[0], false), LocalQueueResult::Ok);
    EXPECT_EQ(Take(), 1u);
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
