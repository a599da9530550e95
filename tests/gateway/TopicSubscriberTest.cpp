// Which samples a subscriber posts, and how it handles the end of an instance.
#include "mirrors/TopicSubscriber.h"

#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitHandlerThread.h>
#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/dynamic/DynamicType.h>

#include <future>
#include <memory>
#include <vector>

#include "BeatSamples.h"
#include "MessageSample.h"
#include "keyed.idl.h"
#include "mirrors/Subscriptions.h"
#include "names/TypeDefinition.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using GatewayTest::Contact;

class Reader final : public TransportReader
{
public:
    int MatchedWriters() const override { return 1; }
};

// Keeps the handler of the one reader.
class Session final : public TransportSession
{
public:
    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &, const TopicQos &,
                                                  const std::vector<std::string> &) override
    {
        return nullptr;
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &, const TopicQos &qos,
                                                  const std::vector<std::string> &,
                                                  SampleHandler handler) override
    {
        Qos = qos;
        Handler = std::move(handler);
        return std::make_unique<Reader>();
    }
    TransportCounters Counters() const override { return {}; }

    SampleHandler Handler;
    TopicQos Qos;
};

class TopicSubscriberTest : public testing::Test
{
protected:
    TopicSubscriberTest()
    {
        origins.Set("uav1", {.Incarnation = 5, .Source = {}, .SourceToWall = 0s});
        workspace.AddPublishSubscribeMessage("uav1/Contact", mirrored);
        subscriber.Open(session);
        subscriber.SetOffer("uav1", QosProfile::State);
    }

    void Hear(std::uint32_t number, std::int64_t time, const std::string &node = "uav1",
              const std::string &text = "here")
    {
        Contact contact;
        contact.number = number;
        contact.text = text;
        const MessageSample sample(contact);
        std::vector<std::uint8_t> bytes(sample.EncodedSize());
        ASSERT_TRUE(sample.Encode(bytes));
        SampleInfo info = InfoOf(number, time);
        info.Node = node;
        session.Handler(bytes, info);
    }

    void HearOfTheEndOf(std::uint32_t number, std::int64_t time)
    {
        SampleInfo info = InfoOf(number, time);
        info.Alive = false;
        session.Handler({}, info);
    }

    void HearBytes(std::vector<std::uint8_t> bytes, std::int64_t time)
    {
        session.Handler(bytes, InfoOf(0, time));
    }

    Gateway::TopicStatus Counters() const { return subscriber.Status().at(0); }

    // Returns the shown number if it was posted since the last call, else -1.
    int Posted() { return mirrored->FetchMessage() ? static_cast<int>(mirrored->number) : -1; }

    SampleInfo InfoOf(std::uint32_t number, std::int64_t time)
    {
        SampleInfo info;
        info.Node = "uav1";
        info.Incarnation = 5;
        info.SourceTime = time;
        info.Sequence = ++_sequence;
        info.Key[3] = static_cast<std::uint8_t>(number);
        return info;
    }

    RabitWorkspace workspace{std::make_shared<ManualClock>(1.4e9, 1000s)};
    OriginTable origins;
    Session session;
    std::shared_ptr<Contact> mirrored = std::make_shared<Contact>();
    const SubscribeRule rule{.Message = "Contact", .Type = "GatewayTest::Contact", .From = {"*"}};
    TopicSubscriber subscriber{rule, Contact::IdlType(), origins, workspace};

private:
    std::uint64_t _sequence = 0;
};

TEST_F(TopicSubscriberTest, TheEndOfAFormerInstanceIsNotTakenForTheEndOfTheValue)
{
    Hear(1, 1'000'000'000);
    EXPECT_EQ(Posted(), 1);
    Hear(2, 2'000'000'000);
    EXPECT_EQ(Posted(), 2);
    HearOfTheEndOf(1, 2'000'000'000);
    EXPECT_EQ(Posted(), -1);
    EXPECT_EQ(mirrored->number, 2u);
    Hear(3, 3'000'000'000);
    EXPECT_EQ(Posted(), 3);
}

TEST_F(TopicSubscriberTest, AMirroredMessageHasNoIntsOfAPostByAManagerHere)
{
    mirrored->MessageSource = 5;
    mirrored->PostMessage();
    for (const std::uint32_t number : {1u, 2u})
    {
        Hear(number, number * 1'000'000'000);
        EXPECT_EQ(Posted(), static_cast<int>(number));
        EXPECT_EQ(mirrored->MessageSource, 0);
    }
}

// The new sample was lost on its way, or was overtaken.
TEST_F(TopicSubscriberTest, TheEndOfAnInstanceBeforeItsSuccessorLeavesTheValueUntilThatIsThere)
{
    Hear(1, 1'000'000'000);
    EXPECT_EQ(Posted(), 1);
    HearOfTheEndOf(1, 2'000'000'000);
    EXPECT_EQ(Posted(), -1);
    EXPECT_EQ(mirrored->number, 1u);
    Hear(2, 2'000'000'000);
    EXPECT_EQ(Posted(), 2);
}

// Notes the mirrored samples.
class MirrorTap final : public GatewayTap
{
public:
    void Sent(const QueueMessage &) override {}
    void Refused(const QueueMessage &, std::string_view) override {}
    void Settled(std::string_view, std::string_view, std::uint64_t, QueueOutcome) override {}
    void Received(const QueueMessage &) override {}
    void Mirrored(const MirroredSample &sample) override
    {
        Times.push_back(sample.SourceTime);
        Incarnations.push_back(sample.Incarnation);
        Bytes.assign(sample.Sample.begin(), sample.Sample.end());
    }
    void Clocks(std::uint64_t, std::chrono::nanoseconds, const std::vector<PeerClock> &) override {}
    std::vector<Gateway::Problem> Problems() override { return {}; }

    std::vector<std::int64_t> Times;
    std::vector<std::uint64_t> Incarnations;
    std::vector<std::uint8_t> Bytes;
};

TEST_F(TopicSubscriberTest, TheTapIsToldOfEachPostedSampleAndOfNoOther)
{
    const auto tap = std::make_shared<MirrorTap>();
    TopicSubscriber other(rule, Contact::IdlType(), origins, workspace, nullptr, tap);
    other.Open(session);
    other.SetOffer("uav1", QosProfile::State);
    Hear(1, 2'000'000'000);
    Hear(1, 2'000'000'000);  // repeated
    Hear(2, 1'000'000'000);  // overtaken
    HearBytes({1, 2, 3}, 3'000'000'000);
    EXPECT_EQ(tap->Times, std::vector<std::int64_t>{2'000'000'000});
    EXPECT_EQ(tap->Incarnations, std::vector<std::uint64_t>{5});
    Contact contact;
    EXPECT_TRUE(Contact::IdlType().Deserialize(tap->Bytes, contact));
    EXPECT_EQ(contact.number, 1u);
}

// The transport's thread must go on: it brings the beats of other nodes.
// Its bytes may decode as something else.
TEST_F(TopicSubscriberTest, PostsNothingOfANodeThatAnnouncesAnotherDefinitionOfTheType)
{
    const SubscribeRule telemetry{
        .Message = "Contact", .Type = "GatewayTest::Contact", .From = {"*"}, .Qos = QosProfile::Telemetry};
    TopicSubscriber other(telemetry, Contact::IdlType(), origins, workspace);
    other.Open(session);
    other.SetOffer("uav1", std::nullopt, true);
    Hear(1, 1'000'000'000);
    EXPECT_EQ(Posted(), -1);
    EXPECT_EQ(other.Status().at(0).refused, 1u);
    other.SetOffer("uav1", QosProfile::Telemetry);
    Hear(2, 2'000'000'000);
    EXPECT_EQ(Posted(), 2);
    other.SetOffer("uav1", std::nullopt, true);
    Hear(3, 3'000'000'000);
    EXPECT_EQ(Posted(), -1);
    EXPECT_EQ(other.Status().at(0).refused, 2u);
}

TEST_F(TopicSubscriberTest, PostsAgainAfterSubscriptionsHaveMatchedTheDefinition)
{
    for (const bool isSame : {false, true})
    {
        Gateway::PublishedMessage published;
        published.message = "Contact";
        published.type = "GatewayTest::Contact";
        published.qos = "telemetry";
        published.definition = DefinitionHash(Contact::IdlType()) + (isSame ? 0u : 1u);
        Gateway::Announcement announcement;
        announcement.publishes.push_back(published);
        HeardBeat heard;
        heard.Node = "uav1";
        heard.Incarnation = 5;
        heard.Beat = BeatAt(1s);
        heard.Arrival = 1s;
        Announce(heard.Beat, announcement);
        PeerTable peers{"ground", 1};
        peers.OnBeat(heard);
        Subscriptions subscriptions(
            {{.Message = "Contact", .Type = "GatewayTest::Contact", .From = {"uav1"}}}, origins, workspace);
        subscriptions.Open(session);
        subscriptions.OnOffers(peers);
        Hear(isSame ? 2u : 1u, isSame ? 2'000'000'000 : 1'000'000'000);
        EXPECT_EQ(Posted(), isSame ? 2 : -1);
        subscriptions.Close();
    }
}

TEST_F(TopicSubscriberTest, TellsOfWhichIncarnationThePostedSamplesWere)
{
    EXPECT_EQ(subscriber.PostedOf("uav1"), std::nullopt);
    Hear(1, 1'000'000'000);
    EXPECT_EQ(subscriber.PostedOf("uav1"), std::uint64_t{5});
    origins.Set("uav1", {.Incarnation = 6, .Source = {}, .SourceToWall = 0s});
    Hear(2, 2'000'000'000);
    EXPECT_EQ(subscriber.PostedOf("uav1"), std::uint64_t{5}) << "a sample of the former one is refused";
}

TEST_F(TopicSubscriberTest, ASlowHandlerHoldsUpNeitherTheTransportNorWhatComesNext)
{
    RabitHandlerThread handlers;
    TopicSubscriber other(rule, Contact::IdlType(), origins, workspace, &handlers);
    other.Open(session);
    other.SetOffer("uav1", QosProfile::State);
    std::promise<void> began;
    std::promise<void> mayReturn;
    std::vector<std::uint32_t> seen;
    mirrored->Register_SomethingPublished(
        [&]
        {
            if (seen.empty())
            {
                began.set_value();
                mayReturn.get_future().wait();
            }
            Contact contact;
            workspace.FetchMessage("uav1/Contact", &contact);
            seen.push_back(contact.number);
        });
    Hear(1, 1'000'000'000);
    began.get_future().wait();
    Hear(2, 2'000'000'000);
    Hear(3, 3'000'000'000);
    EXPECT_EQ(Posted(), 3);
    EXPECT_EQ(other.Status().at(0).received, 3u);
    mayReturn.set_value();
    handlers.Stop();
    EXPECT_EQ(seen, (std::vector<std::uint32_t>{3, 3}));
}

TEST_F(TopicSubscriberTest, TheEndOfTheLastWriterLeavesTheLastValue)
{
    Hear(1, 1'000'000'000);
    EXPECT_EQ(Posted(), 1);
    HearOfTheEndOf(1, 0);
    EXPECT_EQ(Posted(), -1);
    EXPECT_EQ(mirrored->text, "here");
    EXPECT_EQ(subscriber.Status().at(0).received, 1u);
    EXPECT_EQ(subscriber.Status().at(0).refused, 0u);
}

TEST_F(TopicSubscriberTest, ItsReaderIsBestEffortAndVolatile)
{
    EXPECT_EQ(session.Qos.Reliability, Reliability::BestEffort);
    EXPECT_EQ(session.Qos.Durability, Durability::Volatile);
}

TEST_F(TopicSubscriberTest, AStateThatComesAgainIsPostedOnce)
{
    Hear(1, 1'000'000'512);
    EXPECT_EQ(Posted(), 1);
    Hear(1, 1'000'000'512);
    EXPECT_EQ(Posted(), -1);
    EXPECT_EQ(Counters().received, 1u);
    EXPECT_EQ(Counters().repeated, 1u);
}

TEST_F(TopicSubscriberTest, TelemetryOfOneMomentIsPostedAsOftenAsItComes)
{
    subscriber.SetOffer("uav1", QosProfile::Telemetry);
    Hear(1, 1'000'000'512);
    Hear(2, 1'000'000'512);
    EXPECT_EQ(Posted(), 2);
    EXPECT_EQ(Counters().received, 2u);
}

TEST_F(TopicSubscriberTest, WhatIsOlderThanWhatWasPostedIsDropped)
{
    Hear(2, 2'000'000'000);
    EXPECT_EQ(Posted(), 2);
    Hear(1, 1'999'998'000);
    EXPECT_EQ(Posted(), -1);
    EXPECT_EQ(Counters().refused, 1u);
}

TEST_F(TopicSubscriberTest, WhoDoesNotAnnounceAStateIsNotHeardByARuleThatAsksForOne)
{
    SubscribeRule asks = rule;
    asks.Qos = QosProfile::State;
    TopicSubscriber strict(asks, Contact::IdlType(), origins, workspace);
    strict.Open(session);
    Hear(1, 1'000'000'000);
    EXPECT_EQ(Posted(), -1) << "not announced yet";
    strict.SetOffer("uav1", QosProfile::Telemetry);
    Hear(2, 2'000'000'000);
    EXPECT_EQ(Posted(), -1);
    EXPECT_EQ(strict.Status().at(0).refused, 2u);
    EXPECT_FALSE(strict.TakenIn("uav1", 5));
    strict.SetOffer("uav1", QosProfile::State);
    Hear(3, 3'000'000'000);
    EXPECT_EQ(Posted(), 3);
    strict.SetOffer("uav1", std::nullopt);
    Hear(4, 4'000'000'000);
    EXPECT_EQ(Posted(), -1) << "another life, that has not announced itself";
}

TEST_F(TopicSubscriberTest, AStateIsHeardByARuleThatAsksForTelemetry)
{
    SubscribeRule asks = rule;
    asks.Qos = QosProfile::Telemetry;
    TopicSubscriber lenient(asks, Contact::IdlType(), origins, workspace);
    lenient.Open(session);
    lenient.SetOffer("uav1", QosProfile::State);
    Hear(1, 1'000'000'000);
    EXPECT_EQ(Posted(), 1);
}

TEST_F(TopicSubscriberTest, WhatWasTakenInIsKnownOfThePresentLife)
{
    EXPECT_FALSE(subscriber.TakenIn("uav1", 5));
    Hear(1, 1'000'000'000);
    EXPECT_EQ(subscriber.TakenIn("uav1", 5), 1'000'000'000);
    EXPECT_FALSE(subscriber.TakenIn("uav1", 6));
    EXPECT_FALSE(subscriber.TakenIn("uav2", 5));
    Hear(1, 500'000'000);
    EXPECT_EQ(subscriber.TakenIn("uav1", 5), 1'000'000'000) << "it was overtaken";
    origins.Set("uav1", {.Incarnation = 6, .Source = {}, .SourceToWall = 0s});
    Hear(2, 2'000'000'000);
    EXPECT_EQ(subscriber.TakenIn("uav1", 5), 1'000'000'000) << "that life is not the present one";
    subscriber.Forget("uav1");
    EXPECT_FALSE(subscriber.TakenIn("uav1", 5));
}

TEST_F(TopicSubscriberTest, TheMessageOfAForgottenNodeLeavesTheWorkspaceAndReturnsWithTheNode)
{
    origins.Set("uav2", {.Incarnation = 5, .Source = {}, .SourceToWall = 0s});
    subscriber.SetOffer("uav2", QosProfile::State);
    Hear(1, 1'000'000'000, "uav2");
    ASSERT_NE(workspace.FindGlobalMessage("uav2/Contact"), nullptr);
    subscriber.Forget("uav2");
    EXPECT_EQ(workspace.FindGlobalMessage("uav2/Contact"), nullptr);
    subscriber.SetOffer("uav2", QosProfile::State);
    Hear(2, 2'000'000'000, "uav2");
    Contact contact;
    ASSERT_TRUE(workspace.FetchMessage("uav2/Contact", &contact));
    EXPECT_EQ(contact.number, 2u);
}

TEST_F(TopicSubscriberTest, TheMessageOfAForgottenNodeStaysForWhoeverRegisteredIt)
{
    Hear(1, 1'000'000'000);
    subscriber.Forget("uav1");
    subscriber.SetOffer("uav1", QosProfile::State);
    Hear(2, 2'000'000'000);
    EXPECT_EQ(Posted(), 2);
}

// A repeated request would bring the same sample.
TEST_F(TopicSubscriberTest, WhatCannotBeUsedIsTakenInNevertheless)
{
    HearBytes({0, 1, 0, 0, 1, 2, 3}, 1'000'000'000);
    EXPECT_EQ(Counters().undecodable, 1u);
    EXPECT_EQ(subscriber.TakenIn("uav1", 5), 1'000'000'000);
    origins.Set("uav2", {.Incarnation = 5, .Source = {}, .SourceToWall = 0s});
    workspace.AddPublishSubscribeMessage("uav2/Contact", std::make_shared<Uav::Pose>());
    Contact contact;
    const MessageSample sample(contact);
    std::vector<std::uint8_t> bytes(sample.EncodedSize());
    ASSERT_TRUE(sample.Encode(bytes));
    SampleInfo info = InfoOf(0, 3'000'000'000);
    info.Node = "uav2";
    session.Handler(bytes, info);
    EXPECT_EQ(subscriber.TakenIn("uav2", 5), 3'000'000'000);
}

// All types made at run time share one C++ class.
TEST_F(TopicSubscriberTest, ALocalMessageOfAnotherTypeMadeAtRunTimeIsReportedNotExchanged)
{
    const auto local = DynamicType::Parse("struct Number { long value; };", "Number").Type;
    const auto written = DynamicType::Parse("struct Text { string value; };", "Text").Type;
    workspace.AddPublishSubscribeMessage("uav1/Made", local->CreateShared());
    TopicSubscriber made{{.Message = "Made", .Type = "Text", .From = {"*"}}, *written, origins, workspace};
    made.Open(session);
    for (const std::int64_t time : {1'000'000'000, 2'000'000'000})
    {
        ASSERT_NO_THROW(HearBytes(written->DefaultSample(), time));
    }
    EXPECT_EQ(made.LocalProblem("uav1"), "the local message `uav1/Made` is of another type than `Text`");
    EXPECT_TRUE(local->IsTypeOf(*workspace.FindGlobalMessage("uav1/Made")->GetCopyOfMessage()));
}

TEST_F(TopicSubscriberTest, ALargeMessageOfOneNodeTakesNoMemoryForThatOfAnother)
{
    origins.Set("uav2", {.Incarnation = 5, .Source = {}, .SourceToWall = 0s});
    subscriber.SetOffer("uav2", QosProfile::State);
    Hear(1, 1'000'000'000, "uav1", std::string(10'000, 'x'));
    Hear(2, 2'000'000'000, "uav1");
    Hear(3, 3'000'000'000, "uav2");
    const auto global = workspace.FindGlobalMessage("uav2/Contact");
    EXPECT_LT(static_cast<const Contact &>(*global->GetTestMessage()).text.capacity(), 1000u);
}

// Partitions alone do not keep such a node out: with keys, one vendor checks the partitions of its own
// permissions, but not those of others.
TEST_F(TopicSubscriberTest, WhoIsNotAmongThoseThatTheRuleNamesIsNotHeardThroughAPartitionOfTheirs)
{
    SubscribeRule asks = rule;
    asks.From = {"ground", "uav?.vision"};
    TopicSubscriber strict(asks, Contact::IdlType(), origins, workspace);
    strict.Open(session);
    strict.SetOffer("uav1", QosProfile::State);
    Hear(1, 1'000'000'000);
    EXPECT_EQ(Posted(), -1);
    EXPECT_EQ(strict.Status().at(0).refused, 1u);
}

}  // namespace
}  // namespace Rabit
