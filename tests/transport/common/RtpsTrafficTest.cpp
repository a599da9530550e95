// Which messages are of topics, and which of discovery.
#include "common/RtpsTraffic.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

namespace
{

using Bytes = std::vector<std::uint8_t>;

// Appends a submessage of this kind with a body of `size` bytes. The last byte of its writer id is
// `entity`, at index `last` of the body.
Bytes Append(Bytes message, std::uint8_t kind, std::uint8_t size, std::size_t last = 0,
             std::uint8_t entity = 0, bool littleEndian = true)
{
    message.insert(message.end(),
                   {kind, static_cast<std::uint8_t>(littleEndian), littleEndian ? size : std::uint8_t{0},
                    littleEndian ? std::uint8_t{0} : size});
    Bytes body(size);
    if (last < size)
    {
        body[last] = entity;
    }
    message.insert(message.end(), body.begin(), body.end());
    return message;
}

const Bytes Header(20);
constexpr std::uint8_t UserWriter = 0x03;
constexpr std::uint8_t BuiltinWriter = 0xc2;

TEST(RtpsTraffic, SamplesAndTheirRepairAreOfATopicByTheirWriter)
{
    for (const auto kind : std::initializer_list<std::uint8_t>{0x15, 0x16})
    {
        EXPECT_TRUE(Rabit::IsOfSamples(Append(Header, kind, 40, 11, UserWriter)));
        EXPECT_FALSE(Rabit::IsOfSamples(Append(Header, kind, 40, 11, BuiltinWriter)));
    }
    for (const auto kind : std::initializer_list<std::uint8_t>{0x06, 0x07, 0x08, 0x12, 0x13})
    {
        EXPECT_TRUE(Rabit::IsOfSamples(Append(Header, kind, 24, 7, UserWriter)));
        EXPECT_FALSE(Rabit::IsOfSamples(Append(Header, kind, 24, 7, BuiltinWriter)));
    }
}

TEST(RtpsTraffic, WhatComesBeforeInEitherByteOrderIsPassedOver)
{
    for (const bool littleEndian : {true, false})
    {
        const Bytes before =
            Append(Append(Header, 0x0e, 12, 99, 0, littleEndian), 0x09, 8, 99, 0, littleEndian);
        EXPECT_TRUE(Rabit::IsOfSamples(Append(before, 0x15, 40, 11, UserWriter)));
        EXPECT_FALSE(Rabit::IsOfSamples(Append(before, 0x15, 40, 11, BuiltinWriter)));
    }
}

TEST(RtpsTraffic, WhatIsCutOffIsOfNoTopic)
{
    const Bytes message = Append(Header, 0x15, 40, 11, UserWriter);
    for (std::size_t size = 0; size < 20 + 4 + 12; ++size)
    {
        EXPECT_FALSE(Rabit::IsOfSamples({message.data(), size}));
    }
}

// Appends a DATA of the writer of participants, with data or with a key alone.
Bytes AppendParticipant(Bytes message, bool withData = true)
{
    const std::size_t at = message.size();
    message = Append(message, 0x15, 40, 11, BuiltinWriter);
    message[at + 1] = withData ? 0x05 : 0x09;
    message[at + 4 + 9] = 0x01;
    return message;
}

TEST(RtpsTraffic, AnAnnouncementIsFoundWhereverItIs)
{
    const Bytes before = Append(Append(Header, 0x0e, 12), 0x09, 8);
    const auto alone = Rabit::AnnouncingOf(AppendParticipant(before));
    EXPECT_TRUE(alone.Any);
    EXPECT_TRUE(alone.Alone);
    for (const Bytes &message : {AppendParticipant(Append(before, 0x07, 28, 7, BuiltinWriter)),
                                 Append(AppendParticipant(before), 0x07, 28, 7, BuiltinWriter)})
    {
        const auto beside = Rabit::AnnouncingOf(message);
        EXPECT_TRUE(beside.Any);
        EXPECT_FALSE(beside.Alone);
    }
}

TEST(RtpsTraffic, NeitherAGoodbyeNorAnythingElseIsAnAnnouncement)
{
    for (const Bytes &message :
         {Header, AppendParticipant(Header, false), Append(Header, 0x15, 40, 11, BuiltinWriter)})
    {
        const auto announcing = Rabit::AnnouncingOf(message);
        EXPECT_FALSE(announcing.Any);
        EXPECT_FALSE(announcing.Alone);
    }
}

}  // namespace
