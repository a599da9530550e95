// What is let through to the vendor's parser.
#include "RtpsCheck.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <random>
#include <vector>

namespace
{

using Rabit::FastDds::IsSoundRtps;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t Data = 0x15;
constexpr std::uint8_t DataFrag = 0x16;
constexpr std::uint8_t Heartbeat = 0x07;
constexpr std::uint8_t AckNack = 0x06;
constexpr std::uint8_t Gap = 0x08;
constexpr std::uint8_t NackFrag = 0x12;
constexpr std::uint8_t Statistics = 0x80;

void Append(Bytes &to, const Bytes &bytes)
{
    to.insert(to.end(), bytes.begin(), bytes.end());
}

Bytes U32(std::uint32_t value)
{
    return {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8),
            static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 24)};
}

Bytes Concatenate(std::initializer_list<Bytes> parts)
{
    Bytes all;
    for (const auto &part : parts)
    {
        Append(all, part);
    }
    return all;
}

Bytes Sequence(std::int64_t number)
{
    return Concatenate(
        {U32(static_cast<std::uint32_t>(number >> 32)), U32(static_cast<std::uint32_t>(number))});
}

const Bytes Ids = {0, 0, 1, 4, 0, 0, 1, 3};

// A message of one little-endian submessage.
Bytes Message(std::uint8_t kind, const Bytes &body, std::uint8_t flags = 1)
{
    Bytes message = {'R', 'T', 'P', 'S', 2, 3, 1, 15, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    Append(message, {kind, flags, static_cast<std::uint8_t>(body.size()),
                     static_cast<std::uint8_t>(body.size() >> 8)});
    Append(message, body);
    return message;
}

Bytes DataBody(std::int64_t sequence, std::uint8_t toInlineQos = 16,
               const Bytes &rest = {0, 1, 0, 0, 7, 0, 0, 0})
{
    return Concatenate({{0, 0, toInlineQos, 0}, Ids, Sequence(sequence), rest});
}

Bytes FragmentBody(std::uint32_t first, std::uint16_t count, std::uint16_t size, std::uint32_t whole)
{
    const Bytes numbers = {static_cast<std::uint8_t>(count), static_cast<std::uint8_t>(count >> 8),
                           static_cast<std::uint8_t>(size), static_cast<std::uint8_t>(size >> 8)};
    return Concatenate({{0, 0, 28, 0}, Ids, Sequence(1), U32(first), numbers, U32(whole), Bytes(8)});
}

Bytes Set(std::uint32_t bits)
{
    return Concatenate({U32(bits), Bytes(4 * ((bits + 31) / 32))});
}

TEST(RtpsCheck, SoundMessagesPass)
{
    EXPECT_TRUE(IsSoundRtps(Message(Data, DataBody(1), 5)));
    EXPECT_TRUE(IsSoundRtps(Message(DataFrag, FragmentBody(3, 1, 1000, 2500))));
    EXPECT_TRUE(IsSoundRtps(Message(Heartbeat, Concatenate({Ids, Sequence(1), Sequence(0), U32(1)}))));
    EXPECT_TRUE(IsSoundRtps(Message(AckNack, Concatenate({Ids, Sequence(1), Set(256), U32(1)}))));
    EXPECT_TRUE(IsSoundRtps(Message(Gap, Concatenate({Ids, Sequence(3), Sequence(5), Set(0)}))));
    EXPECT_TRUE(IsSoundRtps(Message(NackFrag, Concatenate({Ids, Sequence(1), U32(1), Set(40), U32(1)}))));
    EXPECT_TRUE(IsSoundRtps(Message(0x81, {1, 2, 3, 4})));  // a vendor's own
}

TEST(RtpsCheck, AMessageOfItsHeaderAlonePasses)
{
    Bytes message = Message(Data, {});
    message.resize(20);
    EXPECT_TRUE(IsSoundRtps(message));
}

TEST(RtpsCheck, OtherProtocolsAreDropped)
{
    Bytes message = Message(Data, DataBody(1), 5);
    message[0] = 'X';
    EXPECT_FALSE(IsSoundRtps(message));
    message = Message(Data, DataBody(1), 5);
    message[4] = 9;  // protocol version 9
    EXPECT_FALSE(IsSoundRtps(message));
    EXPECT_FALSE(IsSoundRtps({}));
}

TEST(RtpsCheck, EveryTruncationOfASampleIsDropped)
{
    const Bytes message = Message(Data, DataBody(1), 5);
    for (std::size_t size = 21; size < message.size(); ++size)
    {
        EXPECT_FALSE(IsSoundRtps({message.data(), size})) << size;
    }
}

TEST(RtpsCheck, ASubmessageLongerThanTheDatagramIsDropped)
{
    Bytes message = Message(Data, DataBody(1), 5);
    message[22] = 200;
    EXPECT_FALSE(IsSoundRtps(message));
}

TEST(RtpsCheck, ImpossibleSequenceNumbersAreDropped)
{
    EXPECT_FALSE(IsSoundRtps(Message(Data, DataBody(0), 5)));
    EXPECT_FALSE(IsSoundRtps(Message(Data, DataBody(-1), 5)));
    EXPECT_FALSE(IsSoundRtps(Message(Data, DataBody(INT64_MAX), 5)));
    EXPECT_FALSE(IsSoundRtps(Message(Heartbeat, Concatenate({Ids, Sequence(5), Sequence(3), U32(1)}))));
    EXPECT_FALSE(IsSoundRtps(Message(Heartbeat, Concatenate({Ids, Sequence(0), Sequence(3), U32(1)}))));
    EXPECT_FALSE(IsSoundRtps(Message(Gap, Concatenate({Ids, Sequence(5), Sequence(3), Set(0)}))));
}

TEST(RtpsCheck, ABitmapOfMoreThan256BitsOrWithoutItsWordsIsDropped)
{
    EXPECT_FALSE(IsSoundRtps(Message(AckNack, Concatenate({Ids, Sequence(1), Set(257), U32(1)}))));
    EXPECT_FALSE(IsSoundRtps(Message(AckNack, Concatenate({Ids, Sequence(1), U32(256), U32(1)}))));
}

TEST(RtpsCheck, FragmentsThatDoNotFitTheirSampleAreDropped)
{
    EXPECT_FALSE(IsSoundRtps(Message(DataFrag, FragmentBody(4, 1, 1000, 2500))));
    EXPECT_FALSE(IsSoundRtps(Message(DataFrag, FragmentBody(3, 2, 1000, 2500))));
    EXPECT_FALSE(IsSoundRtps(Message(DataFrag, FragmentBody(0, 1, 1000, 2500))));
    EXPECT_FALSE(IsSoundRtps(Message(DataFrag, FragmentBody(1, 0, 1000, 2500))));
    EXPECT_FALSE(IsSoundRtps(Message(DataFrag, FragmentBody(1, 1, 0, 2500))));
    EXPECT_FALSE(IsSoundRtps(Message(DataFrag, FragmentBody(1, 1, 1000, 0))));
    EXPECT_FALSE(IsSoundRtps(Message(DataFrag, FragmentBody(1, 1, 1000, 0xffffffff))));
}

TEST(RtpsCheck, AnInlineQosThatDoesNotEndIsDropped)
{
    const Bytes sound = {0x71, 0, 4, 0, 0, 0, 0, 1, 1, 0, 0, 0};
    EXPECT_TRUE(IsSoundRtps(Message(Data, DataBody(1, 16, sound), 3)));
    const Bytes endless = {0x71, 0, 4, 0, 0, 0, 0, 1};
    EXPECT_FALSE(IsSoundRtps(Message(Data, DataBody(1, 16, endless), 3)));
    const Bytes tooLong = {0x71, 0, 40, 0, 0, 0, 0, 1, 1, 0, 0, 0};
    EXPECT_FALSE(IsSoundRtps(Message(Data, DataBody(1, 16, tooLong), 3)));
    EXPECT_FALSE(IsSoundRtps(Message(Data, DataBody(1, 8, sound), 3)));
    EXPECT_FALSE(IsSoundRtps(Message(Data, DataBody(1, 60, sound), 3)));
}

// With AddressSanitizer this tells whether anything outside of the datagram is read.
// The vendor ends the process if it finds one of another size, or in another place.
TEST(RtpsCheck, TheVendorsStatisticsPassOnlyWholeAndAtTheEnd)
{
    EXPECT_TRUE(IsSoundRtps(Message(Statistics, Bytes(56, 0))));
    EXPECT_FALSE(IsSoundRtps(Message(Statistics, Bytes(52, 0))));
    EXPECT_FALSE(IsSoundRtps(Message(Statistics, Bytes(60, 0))));
    Bytes followed = Message(Statistics, Bytes(56, 0));
    Append(followed, {Statistics, 1, 56, 0});
    Append(followed, Bytes(56, 0));
    EXPECT_FALSE(IsSoundRtps(followed));
}

TEST(RtpsCheck, AnyBytesAreSafeToCheck)
{
    std::mt19937 random(1);
    const std::vector<Bytes> seeds = {Message(Data, DataBody(1), 3),
                                      Message(DataFrag, FragmentBody(1, 1, 1000, 2500), 3),
                                      Message(AckNack, Concatenate({Ids, Sequence(1), Set(64), U32(1)})),
                                      Message(Gap, Concatenate({Ids, Sequence(3), Sequence(5), Set(32)}))};
    int passed = 0;
    for (int i = 0; i < 200000; ++i)
    {
        Bytes bytes = seeds[random() % seeds.size()];
        for (auto changes = random() % 4; changes > 0; --changes)
        {
            bytes[20 + random() % (bytes.size() - 20)] = static_cast<std::uint8_t>(random());
        }
        bytes.resize(bytes.size() - random() % 3);
        const auto exact = std::make_unique<std::uint8_t[]>(bytes.size());
        std::copy(bytes.begin(), bytes.end(), exact.get());
        passed += IsSoundRtps({exact.get(), bytes.size()}) ? 1 : 0;
    }
    EXPECT_GT(passed, 0);
    EXPECT_LT(passed, 200000);
}

}  // namespace
