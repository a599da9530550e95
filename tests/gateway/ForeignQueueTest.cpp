// The messages of a queue that a gateway writes to a topic of programs that are no nodes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include "ForeignNetwork.h"
#include "foreign/ForeignOutbox.h"
#include "foreign/ForeignPublisher.h"
#include "foreign/ForeignQueues.h"
#include "keyed.idl.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using GatewayTest::Contact;
using testing::ElementsAre;

// Notes what it is told, a word and a number for each.
class NotingTap final : public GatewayTap
{
public:
    void Sent(const QueueMessage &message) override { Note("sent", message); }
    void Refused(const QueueMessage &message, std::string_view reason) override
    {
        Note("refused", message);
        Reason = reason;
    }
    void Settled(std::string_view node, std::string_view queue, std::uint64_t id,
                 QueueOutcome outcome) override
    {
        EXPECT_EQ(node, "");
        EXPECT_EQ(queue, "Contacts");
        EXPECT_EQ(id, LastId);
        Told.push_back(ToString(outcome));
    }
    void Received(const QueueMessage &) override {}
    void Mirrored(const MirroredSample &) override {}
    void Clocks(std::uint64_t, std::chrono::nanoseconds, const std::vector<PeerClock> &) override {}
    std::vector<Gateway::Problem> Problems() override { return {}; }

    std::vector<std::string> Told;
    std::string Reason;
    std::uint64_t LastId = 0;

private:
    void Note(const std::string &what, const QueueMessage &message)
    {
        EXPECT_EQ(message.Node, "");
        EXPECT_EQ(message.Queue, "Contacts");
        Contact contact;
        const bool isContact = Contact::IdlType().Deserialize(message.Sample, contact);
        Told.push_back(what + " " + (isContact ? std::to_string(contact.number) : std::string(message.Type)));
        LastId = message.Id != 0 ? message.Id : LastId;
    }
};

class ForeignQueueTest : public testing::Test
{
protected:
    ForeignQueueTest()
    {
        rule.Way = ForeignRule::Direction::Publish;
        rule.Each = ForeignRule::Delivery::Queue;
        rule.Topic = "contacts";
        rule.Type = "GatewayTest::Contact";
        rule.Local = "Contacts";
        network.Endpoints = {{.Topic = "contacts", .Type = "GatewayTest::Contact"}};
    }

    ForeignPublisher &Publisher()
    {
        if (!publisher)
        {
            outbox = std::make_shared<ForeignOutbox>(
                rule, type, *clock, source, 0, [this] { ++wakes; }, nullptr, tap);
            const auto queues = std::make_shared<ForeignQueues>();
            queues->Add("Contacts", outbox);
            workspace.AddQueueForwarder("Gateway/foreign", queues);
            publisher = std::make_unique<ForeignPublisher>(rule, type, ForeignMatch::Network{7}, workspace,
                                                           source, session, AirCost(1400), outbox);
        }
        return *publisher;
    }
    bool Add(std::uint32_t number, const std::shared_ptr<RabitQueueReceipt> &receipt = nullptr)
    {
        Publisher();
        auto contact = std::make_shared<Contact>();
        contact->number = number;
        return workspace.AddMessageToQueue("Contacts", std::shared_ptr<RabitMessage>(contact), receipt);
    }
    std::chrono::nanoseconds Write()
    {
        Publisher().Service(clock->Monotonic());
        return Publisher().WriteDue(clock->Monotonic());
    }
    std::vector<std::uint32_t> Written() const
    {
        std::vector<std::uint32_t> numbers;
        for (const std::vector<std::uint8_t> &sample : network.Written)
        {
            Contact contact;
            EXPECT_TRUE(type.Deserialize(sample, contact));
            numbers.push_back(contact.number);
        }
        return numbers;
    }
    std::string ProblemText()
    {
        Publisher().Service(clock->Monotonic());
        const auto problem = Publisher().Problem(clock->Monotonic());
        return problem ? problem->subject + ": " + problem->reason : "";
    }

    std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>(1.4e9, 100s);
    RabitWorkspace workspace{clock};
    const SourceClock source{*clock};
    const MessageType &type = *MessageTypeRegistry::Find("GatewayTest::Contact");
    Foreign::Network network;
    Foreign::Session session{network};
    ForeignRule rule;
    int wakes = 0;
    std::shared_ptr<NotingTap> tap;
    std::shared_ptr<ForeignOutbox> outbox;
    std::unique_ptr<ForeignPublisher> publisher;
};

TEST_F(ForeignQueueTest, EachMessageIsWrittenInOrder)
{
    EXPECT_TRUE(Add(3));
    EXPECT_TRUE(Add(4));
    EXPECT_TRUE(Add(4));
    EXPECT_EQ(wakes, 1) << "a gateway that has something to write looks again by itself";
    EXPECT_EQ(Write(), std::chrono::nanoseconds::max());
    EXPECT_THAT(Written(), ElementsAre(3, 4, 4));
    EXPECT_EQ(Publisher().Status().samples, 3u);
    EXPECT_EQ(Publisher().Status().waiting, 0u);
    EXPECT_EQ(network.Disposals, 0) << "a message is no value of the one before";
    EXPECT_TRUE(Add(5));
    EXPECT_EQ(wakes, 2);
}

TEST_F(ForeignQueueTest, AThousandMessagesAtOnceAreWrittenInSeveralTurns)
{
    for (std::uint32_t number = 0; number < 1000; ++number)
    {
        ASSERT_TRUE(Add(number));
    }
    EXPECT_EQ(network.WriterQos.Depth, 1000);
    EXPECT_LE(Write(), clock->Monotonic());
    EXPECT_EQ(network.Written.size(), static_cast<std::size_t>(ForeignPublisher::MostAtOnce));
    for (int turn = 0; turn < 10; ++turn)
    {
        Write();
    }
    EXPECT_EQ(network.Written.size(), 1000u);
}

TEST_F(ForeignQueueTest, IsWrittenNoMoreOftenThanTheRuleAllowsAndNothingIsReplaced)
{
    rule.MaxRate = 10;
    Add(3);
    Add(4);
    EXPECT_EQ(Write(), clock->Monotonic() + 100ms);
    EXPECT_THAT(Written(), ElementsAre(3));
    EXPECT_EQ(Publisher().Status().waiting, 1u);
    clock->Advance(100ms);
    Write();
    EXPECT_THAT(Written(), ElementsAre(3, 4));
    EXPECT_EQ(Publisher().Status().replaced, 0u);
}

TEST_F(ForeignQueueTest, AMessageThatTheNetworkDidNotTakeIsTriedAgain)
{
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    Add(3, receipt);
    network.Result = WriteResult::TimedOut;
    EXPECT_EQ(Write(), clock->Monotonic() + ForeignPublisher::RetryGap);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Pending);
    network.Result = WriteResult::Ok;
    clock->Advance(ForeignPublisher::RetryGap);
    Write();
    EXPECT_THAT(Written(), ElementsAre(3));
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Delivered);
    EXPECT_EQ(Publisher().Status().write_failures, 1u);
}

TEST_F(ForeignQueueTest, AMessageThatCanNeverBeSentIsRefusedLater)
{
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    network.Result = WriteResult::TooLarge;
    EXPECT_TRUE(Add(3, receipt));
    EXPECT_EQ(Write(), std::chrono::nanoseconds::max());
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Refused);
}

TEST_F(ForeignQueueTest, NoMoreThanTheCapacityWaitsAndRefusalsAreCountedUntilThereIsRoom)
{
    rule.Capacity = 2;
    EXPECT_TRUE(Add(1));
    EXPECT_TRUE(Add(2));
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    EXPECT_FALSE(Add(3, receipt));
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Refused);
    EXPECT_EQ(receipt->RefusalReason(), "messages come faster than they can be sent, and no more may wait");
    EXPECT_EQ(Publisher().Status().refused, 1u);
    EXPECT_EQ(ProblemText(),
              "foreign contacts: messages are refused: messages come faster than they can be sent, and no "
              "more may wait");
    Write();
    EXPECT_TRUE(Add(4));
    EXPECT_EQ(ProblemText(), "");
    Write();
    EXPECT_THAT(Written(), ElementsAre(1, 2, 4));
    EXPECT_EQ(Publisher().Status().refused, 1u);
}

TEST_F(ForeignQueueTest, ARefusalIsAProblemForAMinute)
{
    rule.Capacity = 1;
    Add(1);
    Add(2);
    clock->Advance(ForeignOutbox::Memory);
    EXPECT_EQ(ProblemText(), "");
}

TEST_F(ForeignQueueTest, NoMoreBytesWaitThanTheCapacityButALargerMessageAlone)
{
    rule.CapacityBytes = 1;
    EXPECT_TRUE(Add(1));
    EXPECT_FALSE(Add(2));
    Write();
    EXPECT_TRUE(Add(3));
}

TEST_F(ForeignQueueTest, RefusesAMessageOfAnotherType)
{
    Publisher();
    EXPECT_FALSE(workspace.AddMessageToQueue("Contacts",
                                             std::shared_ptr<RabitMessage>(std::make_shared<Uav::Pose>())));
    EXPECT_EQ(Publisher().Status().refused, 1u);
    EXPECT_EQ(
        ProblemText(),
        "foreign contacts: messages are refused: the queue `Contacts` takes `GatewayTest::Contact`, not "
        "`Uav::Pose`");
}

TEST_F(ForeignQueueTest, DropsAndCountsWhatNobodyReads)
{
    network.Readable = 0;
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    EXPECT_TRUE(Add(3, receipt));
    Write();
    EXPECT_TRUE(network.Written.empty());
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Refused);
    EXPECT_EQ(Publisher().Status().unread, 1u);
    EXPECT_EQ(Publisher().Status().samples, 0u);
}

TEST_F(ForeignQueueTest, IsWrittenForReadersThatMayStillCome)
{
    rule.Durability = Durability::TransientLocal;
    network.Readable = 0;
    Add(3);
    Write();
    EXPECT_THAT(Written(), ElementsAre(3));
    EXPECT_EQ(Publisher().Status().unread, 0u);
}

TEST_F(ForeignQueueTest, TellsTheTapOfEachMessageAndItsOutcome)
{
    tap = std::make_shared<NotingTap>();
    rule.Capacity = 1;
    Add(3);
    Add(4);
    Write();
    EXPECT_THAT(tap->Told, ElementsAre("sent 3", "refused 4", "delivered"));
    EXPECT_EQ(tap->Reason, "messages come faster than they can be sent, and no more may wait");
}

TEST_F(ForeignQueueTest, MessagesThatStillWaitAtTheEndAreExpiredAndLaterOnesRefused)
{
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    Add(3, receipt);
    EXPECT_EQ(outbox->Close(), 1u);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Expired);
    EXPECT_FALSE(Add(4));
}

TEST_F(ForeignQueueTest, SaysThatAManagersQueueGetsTheMessages)
{
    using Queue = RabitMessageQueue<std::shared_ptr<RabitMessage>>;
    workspace.AddManagerMessageQueue("Contacts", std::make_shared<Queue>(10, "Contacts"));
    EXPECT_EQ(
        ProblemText(),
        "foreign contacts: a manager has a queue `Contacts`, which gets the messages in place of the topic");
}

}  // namespace
}  // namespace Rabit
