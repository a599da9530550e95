// `Introductions` on datagrams that the guard has admitted.
#include "Introductions.h"

#include <gtest/gtest.h>

#include "guard/DeliveryCheck.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::FastDds::Introductions;
using Rabit::Rtps::ParticipantWriter;
using Said = Introductions::Message;

constexpr std::uint8_t HasData = 5;  // and little-endian
constexpr std::uint8_t HasInlineQosAndKey = 1 | 2 | 8;

// An announcement with these flags of builtin endpoints.
Bytes Announcement(std::uint32_t endpoints)
{
    const Bytes parameters =
        List({Parameter(0x0050, Guid(Sender, 0x000001c1)), Parameter(0x0058, U32(endpoints))});
    return Message(Data, DataBody(1, parameters, ParticipantWriter), HasData);
}

TEST(Introductions, AnAnnouncementIsTakenOnce)
{
    Introductions introductions;
    Bytes announcement = ParticipantMessage();
    EXPECT_FALSE(introductions.Has(Sender));
    EXPECT_EQ(introductions.Read(announcement), Said::Announcement);
    EXPECT_TRUE(introductions.Has(Sender));
    EXPECT_FALSE(introductions.Has(Other));
    EXPECT_EQ(introductions.Take(Sender), announcement);
    EXPECT_TRUE(introductions.Take(Sender).empty());
    EXPECT_FALSE(introductions.Has(Sender));
}

TEST(Introductions, TheNewestAnnouncementIsTaken)
{
    Introductions introductions;
    Bytes first = ParticipantMessage(Sender, 7410);
    Bytes second = ParticipantMessage(Sender, 7412);
    introductions.Read(first);
    introductions.Read(second);
    EXPECT_EQ(introductions.Take(Sender), second);
}

TEST(Introductions, TheVendorDoesNotSeeThatThePeerHasProtectedAnnouncements)
{
    Introductions introductions;
    Bytes announcement = Announcement(0x0fcf003f);
    introductions.Read(announcement);
    EXPECT_EQ(announcement, Announcement(0x03cf003f));
    EXPECT_EQ(introductions.Take(Sender), announcement);
}

TEST(Introductions, AGoodbyeIsToldAndNotRemembered)
{
    Introductions introductions;
    const Bytes qos = List({Parameter(0x0070, Guid(Sender, 0x000001c1)), Parameter(0x0071, {0, 0, 0, 3})});
    const Bytes key = List({Parameter(0x0050, Guid(Sender, 0x000001c1))});
    // The inline QoS has no encapsulation in front of it.
    const Bytes rest = Join({Bytes(qos.begin() + 4, qos.end()), key});
    Bytes goodbye = Message(Data, DataBody(2, rest, ParticipantWriter), HasInlineQosAndKey);
    EXPECT_EQ(introductions.Read(goodbye), Said::Goodbye);
    EXPECT_FALSE(introductions.Has(Sender));
}

TEST(Introductions, OtherDatagramsAreNotRemembered)
{
    Introductions introductions;
    Bytes sample = Message(Data, DataBody(1), HasData);
    Bytes both = Join({ParticipantMessage(), Submessage(Heartbeat, HeartbeatBody(1, 2, 3))});
    EXPECT_EQ(introductions.Read(sample), Said::Other);
    EXPECT_EQ(introductions.Read(both), Said::Other);
    EXPECT_FALSE(introductions.Has(Sender));
}

}  // namespace
