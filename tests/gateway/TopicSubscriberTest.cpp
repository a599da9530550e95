// What a subscriber does when it hears that an instance is no more.
#include "mirrors/TopicSubscriber.h"

#include <gtest/gtest.h>
#include <rabit/ManualClock.h>

#include <memory>
#include <vector>

#include "MessageSample.h"
#include "keyed.idl.h"

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
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &, const TopicQos &,
                                                  const std::vector<std::string> &,
                                                  SampleHandler handler) override
    {
        Handler = std::move(handler);
        return std::make_unique<Reader>();
    }
    TransportCounters Counters() const override { return {}; }

    SampleHandler Handler;
};

class TopicSubscriberTest : public testing::Test
{
protected:
    TopicSubscriberTest()
    {
        origins.Set("uav1", {.Incarnation = 5, .Source = {}, .SourceToWall = 0s});
        workspace.AddPublishSubscribeMessage("uav1/Contact", mirrored);
        subscriber.Open(session);
    }

    void Hear(std::uint32_t number, std::int64_t time)
    {
        Contact contact;
        contact.number = number;
        contact.text = "here";
        const MessageSample sample(contact);
        std::vector<std::uint8_t> bytes(sample.EncodedSize());
        ASSERT_TRUE(sample.Encode(bytes));
        SampleInfo info = InfoOf(number, time);
        session.Handler(bytes, info);
    }

    void HearOfTheEndOf(std::uint32_t number, std::int64_t time)
    {
        SampleInfo info = InfoOf(number, time);
        info.Alive = false;
        session.Handler({}, info);
    }

    // The number that is shown if it was posted anew, else -1.
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
    TopicSubscriber subscriber{rule, QosProfile::State, Contact::IdlType(), origins, workspace};

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

// The new sample was lost on its way, or is overtaken.
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

}  // namespace
}  // namespace Rabit
