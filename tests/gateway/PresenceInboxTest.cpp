#include "presence/PresenceInbox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "BeatSamples.h"
#include "wire/BeatNews.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

template <typename Message>
std::vector<std::uint8_t> Encoded(const Message &message)
{
    const MessageType &type = GatewayTopics::TypeOf<Message>();
    std::vector<std::uint8_t> bytes(type.SerializedSize(message));
    EXPECT_EQ(type.Serialize(message, bytes), bytes.size());
    return bytes;
}

// Returns an announcement that accepts queues `q0`, `q1` ... with `types` types each.
Gateway::Announcement Accepting(std::size_t queues, std::size_t types, const std::string &typeName = "T")
{
    Gateway::Announcement announcement;
    for (std::size_t q = 0; q < queues; ++q)
    {
        Gateway::AcceptedQueue accepted;
        accepted.queue = std::string("q").append(std::to_string(q));
        Gateway::QueueType type;
        type.type = typeName;
        accepted.types.assign(types, type);
        announcement.accepts.push_back(accepted);
    }
    return announcement;
}

Gateway::Announcement Publishing(std::size_t messages)
{
    Gateway::Announcement announcement;
    Gateway::PublishedMessage published;
    published.message = "m";
    published.type = "T";
    published.qos = "state";
    announcement.publishes.assign(messages, published);
    return announcement;
}

class PresenceInboxTest : public ::testing::Test
{
protected:
    bool Add(const std::vector<std::uint8_t> &bytes, const std::string &node = "uav1", std::int64_t utc = 1)
    {
        SampleInfo info;
        info.Node = node;
        info.Incarnation = 5;
        info.SourceTime = utc;
        return inbox.AddBeat(bytes, info, 1s);
    }
    bool Add(const Gateway::Beat &said) { return Add(Encoded(said)); }

    PresenceInbox inbox;
    Gateway::Beat beat = BeatAt(1s);
};

TEST_F(PresenceInboxTest, WhoSpeaksIsWhoDdsSaysWroteIt)
{
    ASSERT_TRUE(Add(Encoded(beat), "uav7", 123));
    const auto beats = inbox.Take().Beats;
    ASSERT_EQ(beats.size(), 1u);
    EXPECT_EQ(beats[0].Node, "uav7");
    EXPECT_EQ(beats[0].Incarnation, 5u);
    EXPECT_EQ(beats[0].Utc, 123);
    EXPECT_EQ(beats[0].Arrival, 1s);
}

TEST_F(PresenceInboxTest, AProgramThatIsNoNodeSaysNothingHere)
{
    EXPECT_FALSE(Add(Encoded(beat), ""));
    EXPECT_FALSE(Add(Encoded(beat), "*"));
    EXPECT_EQ(inbox.Dropped(), 2u);
    EXPECT_TRUE(inbox.Take().Beats.empty());
}

TEST_F(PresenceInboxTest, ClocksThatNoneShowsAreDropped)
{
    EXPECT_FALSE(Add(Encoded(beat), "uav1", -1));
    beat.source_ns = std::numeric_limits<std::int64_t>::max();
    EXPECT_FALSE(Add(beat));
    EXPECT_EQ(inbox.Dropped(), 2u);
}

TEST_F(PresenceInboxTest, TheLargestBeatThatANodeSendsIsTaken)
{
    NewsOf(beat).states.resize(512);
    NewsOf(beat).wants.resize(8);
    NewsOf(beat).wants[0].states.resize(64);
    EXPECT_TRUE(Add(beat));
    EXPECT_EQ(inbox.Dropped(), 0u);
}

TEST_F(PresenceInboxTest, MoreStatesThanANodeCanHaveAreDropped)
{
    NewsOf(beat).first_state = 500;
    NewsOf(beat).states.resize(13);
    EXPECT_FALSE(Add(beat));
    NewsOf(beat).states.resize(12);
    EXPECT_TRUE(Add(beat));
}

TEST_F(PresenceInboxTest, QuestionsForMoreStatesThanANodeCanHaveAreDropped)
{
    NewsOf(beat).wants.resize(1);
    NewsOf(beat).wants[0].states.resize(65);
    EXPECT_FALSE(Add(beat));
}

TEST_F(PresenceInboxTest, MoreEntriesThanANodeSendsAreDropped)
{
    NewsOf(beat).delays.resize(PresenceInbox::MostEntries + 1);
    EXPECT_FALSE(Add(beat));
}

TEST_F(PresenceInboxTest, MoreThanOnePartOfAnAnnouncementIsDropped)
{
    NewsOf(beat).parts.resize(2);
    for (Gateway::AnnouncementPart &part : NewsOf(beat).parts)
    {
        part.of = 1;
        part.bytes = {1};
    }
    EXPECT_FALSE(Add(beat));
    NewsOf(beat).parts.pop_back();
    EXPECT_TRUE(Add(beat));
}

TEST_F(PresenceInboxTest, APartThatLiesOutsideTheWholeIsDropped)
{
    Gateway::AnnouncementPart &part = NewsOf(beat).parts.emplace_back();
    part.first = 10;
    part.of = 12;
    part.bytes = {1, 2, 3};
    EXPECT_FALSE(Add(beat));
    part.of = 13;
    EXPECT_TRUE(Add(beat));
    part.bytes.clear();
    EXPECT_FALSE(Add(beat));
}

TEST_F(PresenceInboxTest, APartOfAnAnnouncementThatIsTooLargeIsDropped)
{
    Gateway::AnnouncementPart &part = NewsOf(beat).parts.emplace_back();
    part.of = Announcements::LargestEncoded;
    part.bytes = {1};
    EXPECT_TRUE(Add(beat));
    part.of = Announcements::LargestEncoded + 1;
    EXPECT_FALSE(Add(beat));
}

TEST_F(PresenceInboxTest, ABeatOfAnotherFormatIsNoted)
{
    beat.format = BeatFormat::Present + 1;
    std::vector<std::uint8_t> bytes = Encoded(beat);
    EXPECT_TRUE(Add(bytes, "uav7"));
    // A beat of the first format: the name of the node, and more bytes than a beat of today may have.
    bytes = {0, 1, 0, 0, 5, 0, 0, 0, 'u', 'a', 'v', '8', 0};
    bytes.resize(PresenceInbox::LargestBeat + 1, 1);
    EXPECT_TRUE(Add(bytes, "uav8"));
    const auto contents = inbox.Take();
    EXPECT_TRUE(contents.Beats.empty());
    EXPECT_EQ(contents.OtherFormats, (std::vector<std::string>{"uav7", "uav8"}));
}

TEST_F(PresenceInboxTest, ABeatOfTheOtherByteOrderIsTaken)
{
    const std::vector<std::uint8_t> bytes = Encoded(beat);
    std::vector<std::uint8_t> swapped = bytes;
    swapped[1] = 0;
    const auto swap = [&swapped](std::size_t at, std::size_t size) {
        std::reverse(swapped.begin() + static_cast<long>(at), swapped.begin() + static_cast<long>(at + size));
    };
    swap(4, 2);
    swap(6, 2);
    swap(12, 8);
    EXPECT_TRUE(Add(swapped));
    const auto beats = inbox.Take().Beats;
    ASSERT_EQ(beats.size(), 1u);
    EXPECT_EQ(beats[0].Beat, beat);
}

TEST_F(PresenceInboxTest, GarbageIsDropped)
{
    EXPECT_TRUE(Add({0, 1, 0, 0, 9, 9, 9, 9, 9})) << "it may be of another format";
    std::vector<std::uint8_t> bytes = Encoded(beat);
    bytes.resize(20);
    EXPECT_FALSE(Add(bytes));
    EXPECT_EQ(inbox.Dropped(), 1u);
}

TEST_F(PresenceInboxTest, HoldsNoMoreBytesThanItSays)
{
    NewsOf(beat).parts.resize(1);
    NewsOf(beat).parts[0].of = 4000;
    NewsOf(beat).parts[0].bytes.resize(4000);
    const std::vector<std::uint8_t> large = Encoded(beat);
    std::size_t added = 0;
    while (Add(large) && added < 100'000)
    {
        ++added;
    }
    EXPECT_LE(added * large.size(), PresenceInbox::LargestContents);
    EXPECT_GT((added + 2) * (large.size() + 1000), PresenceInbox::LargestContents);
    EXPECT_EQ(inbox.Dropped(), 1u);
}

TEST(PresenceInbox, HasRoomAgainOnceItsContentsWereTaken)
{
    PresenceInbox inbox;
    const PeerEvent event{PeerEvent::Kind::Appeared, "uav1", 5};
    while (inbox.AddEvent(event) && inbox.Dropped() == 0)
    {
    }
    ASSERT_FALSE(inbox.AddEvent(event));
    EXPECT_GT(inbox.Take().Events.size(), 10'000u);
    EXPECT_TRUE(inbox.AddEvent(event));
}

TEST(Announcements, TheLargestThatANodeMayMakeIsTaken)
{
    for (const auto &announcement :
         {Publishing(Announcements::MostOffers), Accepting(1, Announcements::MostTypes),
          Accepting(1, 1, std::string(Announcements::LongestType, 'T'))})
    {
        EXPECT_EQ(Announcements::Decode(Announcements::Encode(announcement)), announcement);
    }
}

// The announcements exceed the number of entries, of types in all, of queues and types, of bytes, and of
// bytes of a type's name.
TEST(Announcements, WhatExceedsTheBoundsIsNotTaken)
{
    for (const auto &announcement : {Publishing(Announcements::MostOffers + 1), Accepting(33, 32),
                                     Accepting(1000, 1000), Accepting(1, 200, std::string(200, 'T')),
                                     Accepting(1, 1, std::string(Announcements::LongestType + 1, 'T'))})
    {
        EXPECT_EQ(Announcements::Decode(Announcements::Encode(announcement)), std::nullopt);
    }
}

TEST(Announcements, StatesHaveTheirPlacesAmongTheStatesAlone)
{
    Gateway::Announcement announcement = Publishing(3);
    announcement.publishes[0].message = "a";
    announcement.publishes[1].qos = "telemetry";
    announcement.publishes[2].message = "b";
    EXPECT_EQ(Announcements::StatesIn(announcement), 2u);
    EXPECT_EQ(Announcements::StateIndexOf(announcement, "a"), 0u);
    EXPECT_EQ(Announcements::StateIndexOf(announcement, "b"), 1u);
    EXPECT_EQ(Announcements::StateIndexOf(announcement, "m"), std::nullopt);
}

TEST(Announcements, AConfigurationWithinTheBoundsIsAnnouncedAsItIs)
{
    EXPECT_EQ(Announcements::WhyTooLarge(Publishing(Announcements::MostOffers)), "");
}

TEST(Announcements, WhatOthersWouldNotTakeIsSaid)
{
    EXPECT_EQ(Announcements::WhyTooLarge(Publishing(513)),
              "this node would announce 513 messages and queues; others take at most 512");
    EXPECT_EQ(Announcements::WhyTooLarge(Accepting(33, 32)),
              "this node would announce 1056 types of queues; others take at most 1024");
    const std::string bytes = Announcements::WhyTooLarge(Accepting(1, 200, std::string(200, 'T')));
    EXPECT_NE(bytes.find("bytes of names; others take at most 32768"), std::string::npos) << bytes;
    EXPECT_EQ(Announcements::WhyTooLarge(Accepting(1, 1, std::string(300, 'T'))),
              "this node would announce 300 bytes as the name of a type; others take at most 238");
}

}  // namespace
}  // namespace Rabit
