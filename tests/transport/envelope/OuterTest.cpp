// The header in front of each sealed datagram.
#include "envelope/Outer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace
{

using namespace Rabit::Envelope;
using OuterBytes = std::vector<std::uint8_t>;

constexpr Outer Whole = {.Kind = OuterKind::Pairwise,
                         .Class = OuterClass::Bulletin,
                         .Header = 3,
                         .Epoch = 0x1234,
                         .Tag = 0x89abcdef,
                         .Number = 0xfedcba98};

OuterBytes Written(const Outer &outer, std::size_t size = 200)
{
    OuterBytes bytes(size);
    WriteOuter(outer, bytes);
    return bytes;
}

OuterFault FaultOfBytes(const OuterBytes &bytes)
{
    Outer outer;
    return ReadOuter(bytes, outer);
}

TEST(EnvelopeOuter, IsTheSameAfterWritingAndReading)
{
    Outer read;
    ASSERT_EQ(ReadOuter(Written(Whole), read), OuterFault::None);
    EXPECT_EQ(read, Whole);
}

TEST(EnvelopeOuter, HasTheBytesOfItsDescription)
{
    const OuterBytes expected = {0xab, 0x34, 0x12, 0xef, 0xcd, 0xab, 0x89, 0x98, 0xba, 0xdc, 0xfe};
    const OuterBytes written = Written(Whole);
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), written.begin()));
}

TEST(EnvelopeOuter, AddsElevenBytesATagAndASignature)
{
    EXPECT_EQ(OuterOverhead(OuterKind::Pairwise), 11u + 16u);
    EXPECT_EQ(OuterOverhead(OuterKind::Group), 11u + 16u + 64u);
    EXPECT_EQ(OuterOverhead(OuterKind::Claim), 11u + 16u + 64u + 52u);
}

TEST(EnvelopeOuter, IsRefusedWhereTheDatagramIsTooShortForItsKind)
{
    for (const OuterKind kind : {OuterKind::Group, OuterKind::Pairwise, OuterKind::Claim})
    {
        Outer outer = Whole;
        outer.Kind = kind;
        outer.Class = OuterClass::Meeting;
        outer.Header = 0;
        const std::size_t least = OuterOverhead(kind);
        EXPECT_EQ(FaultOfBytes(Written(outer, least)), OuterFault::None);
        OuterBytes bytes = Written(outer);
        for (std::size_t size = 0; size < least; ++size)
        {
            EXPECT_EQ(FaultOfBytes({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}),
                      OuterFault::TooShort);
        }
    }
}

TEST(EnvelopeOuter, IsRefusedWhereTheDatagramIsTooLong)
{
    EXPECT_EQ(FaultOfBytes(Written(Whole, LargestDatagram)), OuterFault::None);
    EXPECT_EQ(FaultOfBytes(Written(Whole, LargestDatagram + 1)), OuterFault::TooLong);
}

TEST(EnvelopeOuter, OfEachFirstByteIsAcceptedOrRefusedForOneReason)
{
    std::set<int> accepted;
    for (int first = 0; first < 256; ++first)
    {
        OuterBytes bytes = Written(Whole);
        bytes[0] = static_cast<std::uint8_t>(first);
        const OuterFault fault = FaultOfBytes(bytes);
        const int kind = first >> 4 & 3;
        const int contents = first >> 2 & 3;
        const OuterFault expected = first >> 6 != 2 ? OuterFault::NotSealed
                                    : kind == 1     ? OuterFault::UnknownKind
                                    : contents == 3 ? OuterFault::UnknownClass
                                    : kind == 3 && (contents != 1 || (first & 3) != 0)
                                        ? OuterFault::WrongClass
                                        : OuterFault::None;
        EXPECT_EQ(fault, expected) << first;
        if (fault == OuterFault::None)
        {
            accepted.insert(first);
        }
    }
    EXPECT_EQ(accepted.size(), 2u * 3u * 4u + 1u);
    EXPECT_FALSE(accepted.contains('R'));
    EXPECT_FALSE(accepted.contains(0));
}

TEST(EnvelopeOuter, HasAnEpoch)
{
    Outer outer = Whole;
    outer.Epoch = 0;
    EXPECT_EQ(FaultOfBytes(Written(outer)), OuterFault::NoEpoch);
}

TEST(EnvelopeOuter, OfAClaimIntroducesItsSender)
{
    End sender;
    sender.Session.fill(0x11);
    sender.Certificate.fill(0x22);
    OuterBytes bytes(OuterSize + IntroductionSize);
    WriteIntroduction(sender, 0x33445566, std::span(bytes).subspan(OuterSize));
    std::uint32_t high = 0;
    EXPECT_EQ(ReadIntroduction(bytes, high), sender);
    EXPECT_EQ(high, 0x33445566u);
}

TEST(EnvelopeOuter, ContextDiffersWithEachOfItsParts)
{
    const auto contextOf = [](const OuterBytes &outer, std::uint64_t number, const End &sender,
                              const SessionId &receiver, const RtpsHeader &left)
    {
        OuterBytes context(OuterContextSize);
        WriteOuterContext(outer, number, sender, receiver, left, context);
        return context;
    };
    const OuterBytes outer = Written(Whole, OuterSize);
    OuterBytes otherOuter = outer;
    otherOuter.back() ^= 1;
    End otherSession;
    otherSession.Session[15] = 1;
    End otherCertificate;
    otherCertificate.Certificate[31] = 1;
    SessionId receiver{};
    receiver[15] = 1;
    RtpsHeader left{};
    left[19] = 1;
    const std::set<OuterBytes> all = {contextOf(outer, 0, {}, AllSessions, {}),
                                      contextOf(otherOuter, 0, {}, AllSessions, {}),
                                      contextOf(outer, std::uint64_t{1} << 32, {}, AllSessions, {}),
                                      contextOf(outer, 0, otherSession, AllSessions, {}),
                                      contextOf(outer, 0, otherCertificate, AllSessions, {}),
                                      contextOf(outer, 0, {}, receiver, {}),
                                      contextOf(outer, 0, {}, AllSessions, left)};
    EXPECT_EQ(all.size(), 7u);
    EXPECT_EQ(std::string(all.begin()->begin(), all.begin()->begin() + 16), "Rabit envelope 1");
}

}  // namespace
