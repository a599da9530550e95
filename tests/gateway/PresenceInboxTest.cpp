#include "presence/PresenceInbox.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "wire/Announcements.h"
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

// Announces queues `q0`, `q1` ... with as many types each.
Gateway::Announcement Accepting(std::size_t queues, std::size_t types, const std::string &typeName = "T")
{
    Gateway::Announcement announcement;
    announcement.node = "uav1";
    announcement.incarnation = 5;
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
    announcement.node = "uav1";
    announcement.incarnation = 5;
    Gateway::PublishedMessage published;
    published.message = "m";
    published.type = "T";
    published.qos = "state";
    announcement.publishes.assign(messages, published);
    return announcement;
}

TEST(PresenceInbox, TakesTheLargestAnnouncementThatANodeMayMake)
{
    SenderCheck senders;
    PresenceInbox inbox(senders);
    EXPECT_TRUE(inbox.AddAnnouncement(Encoded(Publishing(Announcements::MostOffers)), "uav1", 1s));
    EXPECT_TRUE(inbox.AddAnnouncement(Encoded(Accepting(1, Announcements::MostTypes)), "uav1", 1s));
    EXPECT_EQ(inbox.Take().Announcements.size(), 2u);
    EXPECT_EQ(inbox.Dropped(), 0u);
}

TEST(PresenceInbox, AnAnnouncementOfTooManyOffersIsDropped)
{
    SenderCheck senders;
    PresenceInbox inbox(senders);
    EXPECT_FALSE(inbox.AddAnnouncement(Encoded(Publishing(Announcements::MostOffers + 1)), "uav1", 1s));
    EXPECT_EQ(inbox.Dropped(), 1u);
    EXPECT_TRUE(inbox.Take().Announcements.empty());
}

TEST(PresenceInbox, AnAnnouncementOfTooManyTypesInAllIsDropped)
{
    SenderCheck senders;
    PresenceInbox inbox(senders);
    EXPECT_FALSE(inbox.AddAnnouncement(Encoded(Accepting(33, 32)), "uav1", 1s));
    EXPECT_EQ(inbox.Dropped(), 1u);
}

TEST(PresenceInbox, AnAnnouncementOfAThousandQueuesOfAThousandTypesIsDropped)
{
    SenderCheck senders;
    PresenceInbox inbox(senders);
    EXPECT_FALSE(inbox.AddAnnouncement(Encoded(Accepting(1000, 1000)), "uav1", 1s));
    EXPECT_EQ(inbox.Dropped(), 1u);
}

TEST(PresenceInbox, AnAnnouncementWithinItsCountsButOfTooManyBytesIsDropped)
{
    SenderCheck senders;
    PresenceInbox inbox(senders);
    EXPECT_FALSE(inbox.AddAnnouncement(Encoded(Accepting(1, 200, std::string(200, 'T'))), "uav1", 1s));
    EXPECT_EQ(inbox.Dropped(), 1u);
}

TEST(PresenceInbox, AnAnnouncementWithATypeNameThatIsTooLongIsDropped)
{
    SenderCheck senders;
    PresenceInbox inbox(senders);
    EXPECT_FALSE(inbox.AddAnnouncement(
        Encoded(Accepting(1, 1, std::string(Announcements::LongestType + 1, 'T'))), "uav1", 1s));
    EXPECT_TRUE(inbox.AddAnnouncement(Encoded(Accepting(1, 1, std::string(Announcements::LongestType, 'T'))),
                                      "uav1", 1s));
}

TEST(PresenceInbox, ABeatWithNamesThatAreNoneIsDropped)
{
    Gateway::Beat beat;
    beat.node = "uav1";
    beat.echoes.resize(1);
    beat.echoes[0].node = "*";
    SenderCheck senders;
    PresenceInbox inbox(senders);
    EXPECT_FALSE(inbox.AddBeat(Encoded(beat), "uav1", 1s));
    beat.echoes[0].node = "uav2";
    EXPECT_TRUE(inbox.AddBeat(Encoded(beat), "uav1", 1s));
    EXPECT_EQ(inbox.Dropped(), 1u);
}

TEST(PresenceInbox, WhatANodeSaysInAnothersNameIsDropped)
{
    Gateway::Beat beat;
    beat.node = "uav1";
    SenderCheck senders;
    PresenceInbox inbox(senders);
    EXPECT_FALSE(inbox.AddBeat(Encoded(beat), "uav2", 1s));
    EXPECT_FALSE(inbox.AddBeat(Encoded(beat), "", 1s));
    EXPECT_FALSE(inbox.AddAnnouncement(Encoded(Publishing(1)), "uav2", 1s));
    EXPECT_EQ(senders.Refused(), 3u);
    EXPECT_TRUE(inbox.Take().Beats.empty());
}

TEST(PresenceInbox, HoldsNoMoreBytesThanItSays)
{
    SenderCheck senders;
    PresenceInbox inbox(senders);
    const std::vector<std::uint8_t> large = Encoded(Accepting(1, 120, std::string(200, 'T')));
    std::size_t added = 0;
    while (inbox.AddAnnouncement(large, "uav1", 1s) && added < 100'000)
    {
        ++added;
    }
    EXPECT_LE(added * large.size(), PresenceInbox::LargestContents);
    EXPECT_GT((added + 2) * (large.size() + 1000), PresenceInbox::LargestContents);
    EXPECT_EQ(inbox.Dropped(), 1u);
}

TEST(PresenceInbox, HasRoomAgainOnceItsContentsWereTaken)
{
    SenderCheck senders;
    PresenceInbox inbox(senders);
    const PeerEvent event{PeerEvent::Kind::Appeared, "uav1", 5};
    while (inbox.AddEvent(event) && inbox.Dropped() == 0)
    {
    }
    ASSERT_FALSE(inbox.AddEvent(event));
    EXPECT_GT(inbox.Take().Events.size(), 10'000u);
    EXPECT_TRUE(inbox.AddEvent(event));
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
              "this node would announce 300 bytes as the name of a type; others take at most 255");
}

}  // namespace
}  // namespace Rabit
