// How a gateway handles samples of programs that are no nodes.
#include "foreign/ForeignReader.h"

#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/dynamic/DynamicType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <future>

#include "ForeignNetwork.h"
#include "clocks/GpsTime.h"
#include "keyed.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using GatewayTest::Contact;
using Queue = RabitMessageQueue<std::shared_ptr<RabitMessage>>;

constexpr double Gps = 1.4e9;

RemoteEndpoint Program(std::uint8_t id = 1, Reliability reliability = Reliability::BestEffort,
                       Durability durability = Durability::Volatile)
{
    return {.Id = {id},
            .IsWriter = true,
            .Topic = "contacts",
            .Type = "GatewayTest::Contact",
            .Reliability = reliability,
            .Durability = durability};
}

Contact Of(std::uint32_t id)
{
    Contact contact;
    contact.number = id;
    return contact;
}

// Notes what was put into queues.
class ReceivedTap final : public GatewayTap
{
public:
    void Sent(const QueueMessage &) override {}
    void Refused(const QueueMessage &, std::string_view) override {}
    void Settled(std::string_view, std::string_view, std::uint64_t, QueueOutcome) override {}
    void Received(const QueueMessage &message) override
    {
        EXPECT_EQ(message.Node, "");
        EXPECT_EQ(message.Queue, "Contacts");
        Contact contact;
        EXPECT_EQ(message.Type, Contact::IdlType().Name());
        EXPECT_TRUE(Contact::IdlType().Deserialize(message.Sample, contact));
        Numbers.push_back(contact.number);
    }
    void Mirrored(const MirroredSample &) override {}
    void Clocks(std::uint64_t, std::chrono::nanoseconds, const std::vector<PeerClock> &) override {}
    std::vector<Gateway::Problem> Problems() override { return {}; }

    std::vector<std::uint32_t> Numbers;
};

class ForeignReaderTest : public testing::Test
{
protected:
    ForeignReaderTest()
    {
        rule.Topic = "contacts";
        rule.Type = "GatewayTest::Contact";
        rule.Local = "Contact";
        workspace.AddPublishSubscribeMessage("Contact", local);
        network.Endpoints = {Program()};
    }

    ForeignReader &Reader()
    {
        if (!reader)
        {
            reader = std::make_unique<ForeignReader>(
                rule, type, ForeignMatch::Network{7}, workspace, [this] { ++wakes; }, &handlers, tap);
            reader->Open(session, Now());
            reader->Service(Now());
        }
        return *reader;
    }
    std::chrono::nanoseconds Now() const { return clock->Monotonic(); }
    void Advance(std::chrono::nanoseconds time)
    {
        clock->Advance(time);
        Reader().Service(Now());
    }
    // Returns the topic's state and the reason for it.
    std::string Judgement()
    {
        Reader().Service(Now());
        const Gateway::ForeignTopic &status = Reader().Status(Now());
        return std::string(ToString(status.state)) + (status.reason.empty() ? "" : ": ") + status.reason;
    }
    std::string ProblemText()
    {
        Reader().Service(Now());
        const auto problem = Reader().Problem();
        return problem ? problem->subject + ": " + problem->reason : "";
    }
    std::shared_ptr<Queue> QueueOf(int most)
    {
        rule.Each = ForeignRule::Delivery::Queue;
        rule.Local = "Contacts";
        auto queue = std::make_shared<Queue>(most, "Contacts");
        workspace.AddManagerMessageQueue("Contacts", queue);
        return queue;
    }

    std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>(Gps, 100s);
    RabitWorkspace workspace{clock};
    const MessageType &type = *MessageTypeRegistry::Find("GatewayTest::Contact");
    std::shared_ptr<Contact> local = std::make_shared<Contact>();
    Foreign::Network network;
    Foreign::Session session{network};
    ForeignRule rule;
    int wakes = 0;
    RabitHandlerThread handlers;
    std::shared_ptr<ReceivedTap> tap;
    std::unique_ptr<ForeignReader> reader;
};

TEST_F(ForeignReaderTest, AWriterThatDoesNotMatchStaysAProblemWhenAnotherOneMatches)
{
    rule.Reliability = Reliability::Reliable;
    const std::string why = "a program that writes `contacts` is best effort, this node asks for reliable";
    EXPECT_EQ(ProblemText(), "foreign contacts: " + why);
    network.Endpoints.push_back(Program(2, Reliability::Reliable));
    Advance(ForeignReader::LookPeriod);
    network.Deliver(type, Of(7), 1, 2);
    EXPECT_EQ(Judgement(), "UP: " + why);
    EXPECT_EQ(ProblemText(), "foreign contacts: " + why);
    network.Endpoints.erase(network.Endpoints.begin());
    Advance(ForeignReader::LookPeriod);
    EXPECT_EQ(Judgement(), "UP");
    EXPECT_EQ(ProblemText(), "");
}

// A handler that runs until the test lets it return.
struct Held
{
    void operator()()
    {
        Began.set_value();
        MayReturn.get_future().wait();
    }
    std::promise<void> Began;
    std::promise<void> MayReturn;
};

TEST_F(ForeignReaderTest, ASlowHandlerDoesNotHoldUpTheTransport)
{
    Held held;
    int calls = 0;
    local->Register_SomethingPublished(
        [&]
        {
            if (++calls == 1)
            {
                held();
            }
        });
    Reader();
    network.Deliver(type, Of(1), 1);
    held.Began.get_future().wait();
    network.Deliver(type, Of(2), 2);
    ASSERT_TRUE(local->FetchMessage());
    EXPECT_EQ(local->number, 2u);
    held.MayReturn.set_value();
    handlers.Stop();
    EXPECT_EQ(calls, 2);
}

TEST_F(ForeignReaderTest, ASlowHandlerOfAQueueDoesNotHoldUpTheGateway)
{
    Held held;
    const auto queue = QueueOf(10);
    int calls = 0;
    queue->Register_SomethingEnqueued(
        [&]
        {
            if (++calls == 1)
            {
                held();
            }
        });
    Reader();
    network.Deliver(type, Of(1), 1);
    Reader().Service(Now());
    held.Began.get_future().wait();
    network.Deliver(type, Of(2), 2);
    Reader().Service(Now());
    EXPECT_EQ(queue->NoMessagesInQueue(), 2);
    held.MayReturn.set_value();
    handlers.Stop();
    EXPECT_EQ(calls, 2);
}

TEST_F(ForeignReaderTest, PostsTheNewestSampleWithTheTimeOfItsArrival)
{
    Reader();
    network.Deliver(type, Of(3), 1);
    ASSERT_TRUE(local->FetchMessage());
    EXPECT_EQ(local->number, 3u);
    EXPECT_EQ(local->GetAgeSeconds(*clock), 0.0);
    Advance(2s);
    EXPECT_EQ(local->GetAgeSeconds(*clock), 2.0);
    EXPECT_EQ(local->GetTimeStamp(), Gps);
    EXPECT_EQ(Judgement(), "UP");
    EXPECT_EQ(Reader().Status(Now()).samples, 1u);
}

TEST_F(ForeignReaderTest, CountsTheAgeFromTheSourceTimeIfThatIsTrusted)
{
    rule.SourceTimeIsTrusted = true;
    Reader();
    network.Deliver(type, Of(3), 1, 1, GpsTime::ToUtcNanoseconds(Gps - 4));
    ASSERT_TRUE(local->FetchMessage());
    EXPECT_NEAR(local->GetAgeSeconds(*clock), 4.0, 1e-6);
    EXPECT_NEAR(local->GetTimeStamp(), Gps - 4, 1e-6);
}

TEST_F(ForeignReaderTest, TakesNoSourceTimeOfTheFutureNorOfAClockThatWasNeverSet)
{
    rule.SourceTimeIsTrusted = true;
    Reader();
    network.Deliver(type, Of(3), 1, 1, GpsTime::ToUtcNanoseconds(Gps + 100));
    ASSERT_TRUE(local->FetchMessage());
    EXPECT_EQ(local->GetAgeSeconds(*clock), 0.0);
    network.Deliver(type, Of(4), 2, 1, 1234567);
    ASSERT_TRUE(local->FetchMessage());
    EXPECT_EQ(local->GetAgeSeconds(*clock), 0.0);
}

TEST_F(ForeignReaderTest, IsStaleWhenNothingCame)
{
    rule.StaleAfter = 500ms;
    Reader();
    network.Deliver(type, Of(3), 1);
    EXPECT_EQ(Judgement(), "UP");
    EXPECT_LE(Reader().Service(Now()), Now() + 501ms);
    Advance(501ms);
    EXPECT_EQ(Judgement(), "STALE: nothing newer than 0.5 s");
    EXPECT_EQ(ProblemText(), "foreign contacts: nothing newer than 0.5 s");
    network.Deliver(type, Of(4), 2);
    EXPECT_EQ(Judgement(), "UP");
    EXPECT_TRUE(Reader().TakeChange());
    EXPECT_FALSE(Reader().TakeChange());
}

TEST_F(ForeignReaderTest, IsLostWhenItsWriterIsGone)
{
    Reader();
    network.Deliver(type, Of(3), 1);
    EXPECT_EQ(Judgement(), "UP");
    network.Endpoints.clear();
    Advance(ForeignReader::LookPeriod);
    EXPECT_EQ(Judgement(), "LOST: no program writes `contacts` in domain 7");
}

TEST_F(ForeignReaderTest, IsLostWhenItsWriterDisposesOfWhatItShows)
{
    Reader();
    network.Deliver(type, Of(3), 1);
    network.End();
    EXPECT_EQ(Judgement(), "LOST: its writer has disposed of what it shows");
    network.Deliver(type, Of(4), 2);
    EXPECT_EQ(Judgement(), "UP");
}

TEST_F(ForeignReaderTest, GoesOnWhenAnotherInstanceIsDisposed)
{
    Reader();
    network.Deliver(type, Of(3), 1);
    const KeyHash former = network.LastKey;
    network.Deliver(type, Of(4), 2);
    network.LastKey = former;
    network.End();
    EXPECT_EQ(Judgement(), "UP");
}

TEST_F(ForeignReaderTest, SaysThatNothingCameYetAndThatThatIsNoProblem)
{
    EXPECT_EQ(Judgement(), "LOST: the program that writes it has sent nothing that was received");
    EXPECT_EQ(ProblemText(), "");
}

TEST_F(ForeignReaderTest, DropsWhatIsOlderThanWhatItsWriterSentBefore)
{
    Reader();
    network.Deliver(type, Of(3), 5);
    network.Deliver(type, Of(4), 4);
    network.Deliver(type, Of(5), 5);
    ASSERT_TRUE(local->FetchMessage());
    EXPECT_EQ(local->number, 3u);
    EXPECT_EQ(Reader().Status(Now()).overtaken, 2u);
}

TEST_F(ForeignReaderTest, CountsTheNumbersThatNeverCameForEachWriter)
{
    network.Endpoints = {Program(1), Program(2)};
    Reader();
    network.Deliver(type, Of(3), 5, 1);
    network.Deliver(type, Of(3), 9, 1);
    network.Deliver(type, Of(4), 1, 2);
    Advance(ForeignReader::LookPeriod);
    const Gateway::ForeignTopic &status = Reader().Status(Now());
    EXPECT_EQ(status.missed, 3u);
    ASSERT_EQ(status.writers.size(), 2u);
    EXPECT_EQ(status.writers[0].received, 2u);
    EXPECT_EQ(status.writers[0].missed, 3u);
    EXPECT_EQ(status.writers[1].received, 1u);
    EXPECT_EQ(status.writers[0].id.substr(0, 4), "0100");
    EXPECT_EQ(status.writers[0].qos, "best effort, volatile");
}

TEST_F(ForeignReaderTest, OfSeveralWritersTheLastSampleHolds)
{
    Reader();
    network.Deliver(type, Of(3), 100, 1);
    network.Deliver(type, Of(4), 1, 2);
    ASSERT_TRUE(local->FetchMessage());
    EXPECT_EQ(local->number, 4u);
}

TEST_F(ForeignReaderTest, TakesNothingOfNodes)
{
    Reader();
    network.Deliver(type, Of(3), 1, 1, 0, "uav2");
    EXPECT_FALSE(local->FetchMessage());
    EXPECT_EQ(Reader().Status(Now()).of_nodes, 1u);
}

TEST_F(ForeignReaderTest, SaysThatSamplesDoNotDecode)
{
    Reader();
    network.DeliverBytes({0, 1, 0, 0, 1}, 1);
    EXPECT_FALSE(local->FetchMessage());
    EXPECT_EQ(Reader().Status(Now()).undecodable, 1u);
    EXPECT_EQ(ProblemText(),
              "foreign contacts: its samples do not decode as `GatewayTest::Contact`: its program was built "
              "with another version of the type");
    network.Deliver(type, Of(4), 2);
    EXPECT_EQ(ProblemText(), "");
}

TEST_F(ForeignReaderTest, SaysThatTheLocalMessageIsOfAnotherType)
{
    rule.Local = "Other";
    workspace.AddPublishSubscribeMessage("Other", std::make_shared<Gateway::Fleet>());
    Reader();
    network.Deliver(type, Of(3), 1);
    EXPECT_EQ(ProblemText(),
              "foreign contacts: the local message `Other` is of another type than `GatewayTest::Contact`");
    EXPECT_EQ(Reader().Status(Now()).samples, 0u);
}

// All types made at run time share one C++ class.
TEST_F(ForeignReaderTest, SaysThatTheLocalMessageIsOfAnotherTypeMadeAtRunTime)
{
    const auto number = DynamicType::Parse("struct Number { long value; };", "Number").Type;
    const auto text = DynamicType::Parse("struct Text { string value; };", "Text").Type;
    rule.Local = "Made";
    rule.Type = "Text";
    workspace.AddPublishSubscribeMessage("Made", number->CreateShared());
    ForeignReader made(
        rule, *text, ForeignMatch::Network{7}, workspace, [] {}, &handlers);
    made.Open(session, Now());
    for (const std::uint64_t sequence : {1u, 2u})
    {
        ASSERT_NO_THROW(network.DeliverBytes(text->DefaultSample(), sequence));
    }
    made.Service(Now());
    ASSERT_TRUE(made.Problem());
    EXPECT_EQ(made.Problem()->reason, "the local message `Made` is of another type than `Text`");
}

TEST_F(ForeignReaderTest, AsksForWhatTheWritersOfferOnceTheyAreThere)
{
    network.Endpoints.clear();
    Reader();
    ASSERT_EQ(network.Readers.size(), 1u);
    EXPECT_EQ(network.Readers[0].Reliability, Reliability::BestEffort);
    network.Endpoints = {Program(1, Reliability::Reliable, Durability::TransientLocal)};
    Advance(ForeignReader::LookPeriod);
    ASSERT_EQ(network.Readers.size(), 2u);
    EXPECT_EQ(network.Readers[1].Reliability, Reliability::Reliable);
    EXPECT_EQ(network.Readers[1].Durability, Durability::TransientLocal);
    network.Endpoints.clear();
    Advance(ForeignReader::LookPeriod);
    EXPECT_EQ(network.Readers.size(), 2u) << "who comes back should find what it left";
}

TEST_F(ForeignReaderTest, PutsEachSampleIntoTheQueue)
{
    const auto queue = QueueOf(10);
    Reader();
    network.Deliver(type, Of(3), 1);
    network.Deliver(type, Of(4), 2);
    EXPECT_EQ(wakes, 1);
    Reader().Service(Now());
    std::shared_ptr<RabitMessage> message;
    for (const std::uint32_t id : {3u, 4u})
    {
        ASSERT_TRUE(queue->GetMessage(message));
        EXPECT_EQ(dynamic_cast<Contact &>(*message).number, id);
    }
    EXPECT_EQ(Reader().Status(Now()).samples, 2u);
    EXPECT_EQ(Judgement(), "UP");
}

TEST_F(ForeignReaderTest, HoldsSamplesBackWhileTheQueueIsFullAndDropsWhatItCannotHold)
{
    rule.Capacity = 2;
    const auto queue = QueueOf(1);
    Reader();
    for (std::uint32_t i = 1; i <= 4; ++i)
    {
        network.Deliver(type, Of(i), i);
        Reader().Service(Now());
    }
    EXPECT_EQ(Reader().Status(Now()).waiting, 2u);
    EXPECT_EQ(Reader().Status(Now()).overflowed, 1u);
    EXPECT_EQ(ProblemText(), "foreign contacts: the local queue `Contacts` is full; samples are dropped");
    const int before = wakes;
    std::shared_ptr<RabitMessage> message;
    ASSERT_TRUE(queue->GetMessage(message));
    EXPECT_GT(wakes, before) << "room wakes the gateway";
    Reader().Service(Now());
    ASSERT_TRUE(queue->GetMessage(message));
    EXPECT_EQ(dynamic_cast<Contact &>(*message).number, 2u);
    Reader().Service(Now());
    ASSERT_TRUE(queue->GetMessage(message));
    EXPECT_EQ(dynamic_cast<Contact &>(*message).number, 3u);
    EXPECT_EQ(ProblemText(), "");
}

TEST_F(ForeignReaderTest, DropsSamplesWhoseBytesItCannotHold)
{
    Contact large = Of(1);
    large.text = std::string(1000, 'x');
    rule.CapacityBytes = 3000;
    const auto queue = QueueOf(1);
    Reader();
    for (std::uint32_t i = 1; i <= 4; ++i)
    {
        network.Deliver(type, large, i);
        Reader().Service(Now());
    }
    EXPECT_EQ(Reader().Status(Now()).waiting, 2u);
    EXPECT_EQ(Reader().Status(Now()).overflowed, 1u);
    EXPECT_EQ(ProblemText(), "foreign contacts: the local queue `Contacts` is full; samples are dropped");
    std::shared_ptr<RabitMessage> message;
    for (int taken = 1; taken <= 3; ++taken)
    {
        EXPECT_TRUE(queue->GetMessage(message)) << taken;
        Reader().Service(Now());
    }
    EXPECT_EQ(ProblemText(), "");
    network.Deliver(type, large, 5);
    EXPECT_EQ(Reader().Status(Now()).waiting, 1u) << "there is room again";
}

TEST_F(ForeignReaderTest, HoldsASampleAboveTheBytesOnlyAlone)
{
    Contact large = Of(1);
    large.text = std::string(1000, 'x');
    rule.CapacityBytes = 100;
    const auto queue = QueueOf(1);
    Reader();
    for (std::uint32_t i = 1; i <= 3; ++i)
    {
        network.Deliver(type, large, i);
        Reader().Service(Now());
    }
    EXPECT_EQ(Reader().Status(Now()).waiting, 1u);
    EXPECT_EQ(Reader().Status(Now()).overflowed, 1u);
}

TEST_F(ForeignReaderTest, KeepsSamplesForAQueueThatIsNotThereYet)
{
    rule.Each = ForeignRule::Delivery::Queue;
    rule.Local = "Contacts";
    Reader();
    network.Deliver(type, Of(3), 1);
    EXPECT_EQ(ProblemText(), "foreign contacts: there is no local queue `Contacts`");
    const auto queue = QueueOf(3);
    Reader().Service(Now());
    EXPECT_EQ(queue->NoMessagesInQueue(), 1);
    EXPECT_EQ(ProblemText(), "");
}

TEST_F(ForeignReaderTest, TellsTheTapOfEachMessageThatIsPutIntoTheQueueOnce)
{
    tap = std::make_shared<ReceivedTap>();
    const auto queue = QueueOf(2);
    Reader();
    for (std::uint32_t number = 1; number <= 3; ++number)
    {
        network.Deliver(type, Of(number), number);
    }
    Reader().Service(Now());
    EXPECT_EQ(tap->Numbers, (std::vector<std::uint32_t>{1, 2}));
    std::shared_ptr<RabitMessage> message;
    queue->GetMessage(message);
    Reader().Service(Now());
    EXPECT_EQ(tap->Numbers, (std::vector<std::uint32_t>{1, 2, 3}));
}

TEST_F(ForeignReaderTest, DoesNotTakeASampleTwiceThatAWriterSendsAgainToANewReader)
{
    const auto queue = QueueOf(10);
    network.Endpoints.clear();
    Reader();
    network.Deliver(type, Of(3), 1);
    network.Endpoints = {Program(1, Reliability::Reliable, Durability::TransientLocal)};
    Advance(ForeignReader::LookPeriod);
    network.Deliver(type, Of(3), 1);
    network.Deliver(type, Of(4), 2);
    Reader().Service(Now());
    EXPECT_EQ(queue->NoMessagesInQueue(), 2);
}

}  // namespace
}  // namespace Rabit
