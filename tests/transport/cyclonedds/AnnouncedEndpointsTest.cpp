// Which endpoints `LeaveOutIdleEndpoints` removes from announcements.
#include "AnnouncedEndpoints.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/ParticipantIdentity.h"

namespace
{

using Bytes = std::vector<std::uint8_t>;
using Rabit::Cyclone::LeaveOutIdleEndpoints;

constexpr std::uint8_t Data = 0x15;
constexpr std::uint8_t LittleEndian = 1;
constexpr std::uint8_t WithInlineQos = 1 | 2 | 4;
constexpr std::uint8_t WithData = 1 | 4;
constexpr std::uint8_t WithKey = 1 | 2 | 8;
constexpr std::uint32_t Discovery = 0x3f;
constexpr std::uint32_t All = 0xfc3f;
const std::string Node = Rabit::MakeUserData(7);

void Append(Bytes &to, const Bytes &what)
{
    to.insert(to.end(), what.begin(), what.end());
}

Bytes Little(std::uint32_t number, std::size_t size)
{
    Bytes bytes;
    for (std::size_t i = 0; i < size; ++i, number >>= 8)
    {
        bytes.push_back(static_cast<std::uint8_t>(number & 0xff));
    }
    return bytes;
}

Bytes Parameter(std::uint32_t id, const Bytes &value)
{
    Bytes bytes = Little(id, 2);
    Append(bytes, Little(static_cast<std::uint32_t>(value.size()), 2));
    Append(bytes, value);
    return bytes;
}

Bytes Submessage(std::uint8_t kind, std::uint8_t flags, const Bytes &body)
{
    Bytes bytes{kind, flags};
    Append(bytes, Little(static_cast<std::uint32_t>(body.size()), 2));
    Append(bytes, body);
    return bytes;
}

Bytes Announcement(const std::string &userData, std::uint32_t endpoints, std::uint8_t flags = WithInlineQos,
                   std::uint8_t writer = 0x01)
{
    Bytes body{0, 0, 16, 0, 0, 0, 0, 0, 0, writer, 0, 0xc2, 0, 0, 0, 0, 1, 0, 0, 0};
    if ((flags & 2) != 0)
    {
        Append(body, Parameter(0x70, Bytes(16)));
        Append(body, Parameter(1, {}));
    }
    Append(body, {0, 3, 0, 0});
    Bytes data = Little(static_cast<std::uint32_t>(userData.size()), 4);
    Append(data, Bytes(userData.begin(), userData.end()));
    data.resize((data.size() + 3) / 4 * 4);
    Append(body, Parameter(0x2c, data));
    Append(body, Parameter(0x58, Little(endpoints, 4)));
    Append(body, Parameter(1, {}));
    return Submessage(Data, flags, body);
}

Bytes Message(const Bytes &submessages)
{
    Bytes message(20);
    Append(message, Submessage(0x09, LittleEndian, Bytes(8)));
    Append(message, submessages);
    return message;
}

void ExpectUnchanged(const Bytes &message)
{
    Bytes changed = message;
    EXPECT_FALSE(LeaveOutIdleEndpoints(changed));
    EXPECT_EQ(changed, message);
}

TEST(AnnouncedEndpoints, OfANodeThoseOfDiscoveryAreLeft)
{
    for (const std::uint8_t flags : {WithData, WithInlineQos})
    {
        Bytes message = Message(Announcement(Node, All, flags));
        EXPECT_TRUE(LeaveOutIdleEndpoints(message));
        EXPECT_EQ(message, Message(Announcement(Node, Discovery, flags)));
    }
}

TEST(AnnouncedEndpoints, WhatStandsBehindSomethingElseIsFound)
{
    Bytes before = Submessage(0x07, LittleEndian, Bytes(28));
    Bytes message = before;
    Append(message, Announcement(Node, All));
    message = Message(message);
    EXPECT_TRUE(LeaveOutIdleEndpoints(message));
    Append(before, Announcement(Node, Discovery));
    EXPECT_EQ(message, Message(before));
}

TEST(AnnouncedEndpoints, APlainProgramKeepsThem)
{
    ExpectUnchanged(Message(Announcement("", All)));
    ExpectUnchanged(Message(Announcement("something else", All)));
}

TEST(AnnouncedEndpoints, WhatIsNoAnnouncementStaysAsItIs)
{
    ExpectUnchanged(Message(Announcement(Node, All, WithKey)));
    ExpectUnchanged(Message(Announcement(Node, All, WithInlineQos, 3)));
    ExpectUnchanged(Message(Announcement(Node, Discovery)));
}

TEST(AnnouncedEndpoints, WhateverIsCutOffIsReadNoFurther)
{
    const Bytes whole = Message(Announcement(Node, All));
    for (std::size_t size = 0; size + 4 < whole.size(); ++size)
    {
        Bytes message(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        LeaveOutIdleEndpoints(message);
    }
    for (std::size_t at = 20; at < whole.size(); ++at)
    {
        Bytes message = whole;
        message[at] = 0xff;
        LeaveOutIdleEndpoints(message);
    }
}

}  // namespace
