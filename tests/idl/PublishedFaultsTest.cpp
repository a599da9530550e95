// Payloads that readers of the vendors accept, by the issues of Fast DDS, Fast-CDR and Cyclone DDS. Generated
// types and types made at run time read them by the same rules.
#include "reported.idl.h"

#include <rabit/idl/MessageType.h>

#include <gtest/gtest.h>

#include <string_view>

namespace
{

using Bytes = std::vector<std::uint8_t>;

Bytes FromHex(std::string_view digits)
{
    const auto value = [](char digit) { return digit <= '9' ? digit - '0' : digit - 'a' + 10; };
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    {
        bytes.push_back(static_cast<std::uint8_t>(value(digits[i]) << 4 | value(digits[i + 1])));
    }
    return bytes;
}

// The bytes of a sample behind the header of little-endian plain XCDR1.
Bytes Plain(std::string_view digits)
{
    Bytes bytes = {0, 1, 0, 0};
    const Bytes body = FromHex(digits);
    bytes.insert(bytes.end(), body.begin(), body.end());
    return bytes;
}

template <class Message>
bool CanRead(const Bytes &sample)
{
    Message message;
    return Message::IdlType().Deserialize(sample, message);
}

TEST(PublishedFaults, TheHonestPayloadsAreRead)
{
    EXPECT_TRUE(CanRead<Reported::Aligned>(Plain("01000000be000000540000000000000014ae47e17a1409c0")));
    EXPECT_TRUE(CanRead<Reported::Bounded>(
        Plain("090000006f636b676b6e7a6500000000030000003f0000004000000041000000")));
}

// Its length is 5, and all five bytes are characters.
TEST(PublishedFaults, FastCdrIssue331_AStringWithoutATerminatingZeroIsRefused)
{
    EXPECT_TRUE(CanRead<Reported::Bounded>(Plain("05000000637268790000000000000000")));
    EXPECT_FALSE(CanRead<Reported::Bounded>(Plain("05000000637268797600000000000000")));
}

// The list says that it is empty, and three elements follow.
TEST(PublishedFaults, FastDdsIssue6516_CycloneDdsIssue2453_ElementsBehindAnEmptySequenceAreRefused)
{
    EXPECT_FALSE(CanRead<Reported::Bounded>(
        Plain("090000006f636b676b6e7a6500000000000000003f0000004000000041000000")));
}

// More elements than the bound, and more than there are bytes.
TEST(PublishedFaults, Cve2026_45097_SequencesOfTooManyElementsAreRefused)
{
    const std::string_view name = "0200000061000000";
    const auto values = [&](std::string_view count, std::size_t elements)
    { return Plain(std::string(name) + std::string(count) + std::string(8 * elements, '0')); };
    EXPECT_TRUE(CanRead<Reported::Bounded>(values("05000000", 5)));
    EXPECT_FALSE(CanRead<Reported::Bounded>(values("06000000", 6)));
    EXPECT_FALSE(CanRead<Reported::Bounded>(values("05000000", 4)));
    EXPECT_FALSE(CanRead<Reported::Bounded>(values("00000040", 5)));
}

// XCDR2 with a length in front of the body that is one too large (6492) or one too small (6512). Also with a
// body of another layout (6491, Cyclone DDS 2436). Nodes offer and read XCDR1 alone.
TEST(PublishedFaults, FastDdsIssues6491_6492_6512_CycloneDdsIssue2436_Xcdr2IsRefused)
{
    for (const std::string_view sample : {"00090000140000000000000098ffffffa900000075931804560e1ec0",
                                          "0009000015000000000000000098ffffffa900000075931804560e1ec0",
                                          "00090000130000000000000098ffffffa900000075931804560e1ec0",
                                          "0009000018000000000000200000000098ffffffa900000075931804560e1ec0"})
    {
        EXPECT_FALSE(CanRead<Reported::Aligned>(FromHex(sample))) << sample;
    }
}

// A payload of nothing but the header, which Cyclone DDS takes for an appendable value of zeros.
TEST(PublishedFaults, CycloneDdsIssue2432_AnEmptyPayloadIsRefused)
{
    EXPECT_FALSE(CanRead<Reported::Aligned>(Plain("")));
    EXPECT_FALSE(CanRead<Reported::Bounded>(Plain("")));
}

// One byte more in front of the second member. Nothing in XCDR1 shows that: gaps may have any bytes, and up
// to three bytes of padding may follow. The issue's reader gets the same wrong values.
TEST(PublishedFaults, FastDdsIssue6517_AByteTooManyInAGapIsNotNoticed)
{
    Reported::Aligned message;
    ASSERT_TRUE(Reported::Aligned::IdlType().Deserialize(
        Plain("0100000000be000000540000000000000014ae47e17a1409c0"), message));
    EXPECT_EQ(message.counter, 48640);
    EXPECT_EQ(message.marker, 0);
}

}  // namespace
