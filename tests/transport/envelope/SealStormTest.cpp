// Many datagrams: those that end like statistics of Fast DDS, and damaged ones. RABIT_SEAL_STORM multiplies
// how many.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <random>

#include "SealNodes.h"

namespace
{

using namespace SealNodes;
using std::chrono::seconds;

std::uint64_t Storm(std::uint64_t datagrams)
{
    const char *const factor = std::getenv("RABIT_SEAL_STORM");
    return datagrams * (factor == nullptr ? 1 : std::strtoull(factor, nullptr, 10));
}

class SealStorm : public testing::Test, protected Three
{
};

// The vendor's sockets write 56 bytes behind a byte of that value.
TEST_F(SealStorm, NoDatagramEndsLikeStatistics)
{
    Bytes out(2000);
    const Receiver toB = A.ReceiverOf(B);
    std::uint64_t padded = 0;
    const std::uint64_t count = Storm(20'000);
    for (std::uint64_t i = 0; i < count; ++i)
    {
        const Bytes message = A.Message(4 + 4 * (i % 40));
        const bool signs = i % 10 == 0;
        const Sealer::Result result = signs ? A.Seals.SealGroup(message, OuterClass::Traffic, out)
                                            : A.Seals.SealPairwise(message, OuterClass::Traffic, toB, out);
        ASSERT_EQ(result.Fault, SealFault::None);
        const auto datagram = std::span(out).first(result.Size);
        ASSERT_FALSE(LooksLikeStatistics(datagram));
        ASSERT_LE(result.Size, message.size() + Sealer::MostAdded);
        const Opener::Result opened = B.Opens.Open(datagram, Start);
        ASSERT_EQ(opened.Fault, OpenFault::None);
        const std::size_t size = message.size() + (signs ? 71 : 7);
        ASSERT_TRUE(std::equal(message.begin(), message.end(), opened.Message.begin()));
        // All bytes behind the message are submessages PAD.
        ASSERT_EQ((result.Size - size) % 4, 0u);
        for (std::size_t at = message.size(); at < opened.Message.size(); at += 4)
        {
            ASSERT_EQ(BytesOf(opened.Message.subspan(at, 4)), (Bytes{1, 1, 0, 0}));
        }
        padded += (result.Size - size) / 4;
    }
    // One of 256, but for those that are too short.
    EXPECT_GT(padded, count / 1024);
    EXPECT_LT(padded, count / 128);
    EXPECT_EQ(A.Seals.Next() - 2, count + padded);
}

// Bytes of the outer header may be what the vendor looks for: no new number changes the tag.
TEST_F(SealStorm, AHeaderThatLooksLikeStatisticsIsMovedByPadding)
{
    for (std::size_t at = 0; at < sizeof(SessionTag); ++at)
    {
        Node node(Signs, "uav7", 7);
        for (std::uint8_t i = 0; (TagOf(node.Me.Own) >> 8 * at & 0xff) != 0x80; ++i)
        {
            node.Me.Own.Session[i % 16] = static_cast<std::uint8_t>(node.Me.Own.Session[i % 16] + i);
        }
        node.Meet(B);
        Sealer seals(node.Me, node.Epochs);
        // Sealed, the byte of the tag has 59 behind it.
        const std::size_t size = 60 + 3 + at - 7 - 20 - 4;
        Bytes out(500);
        const Sealer::Result result =
            seals.SealPairwise(node.Message(size), OuterClass::Traffic, node.ReceiverOf(B), out);
        // Padding is a submessage, which begins at a multiple of 4: a message of another size cannot be
        // padded.
        EXPECT_EQ(result.Fault, size % 4 == 0 ? SealFault::None : SealFault::EndsLikeStatistics);
        EXPECT_EQ(seals.Next(), size % 4 == 0 ? 2u : Sealer::MostTries);
    }
}

// A submessage of the length 0 extends to the end of the message, and would swallow padding.
TEST_F(SealStorm, AMessageWhoseLastSubmessageIsOpenIsNotPadded)
{
    Bytes open = A.Message(100);
    open[22] = 0;
    Bytes openAndEmpty = A.Message(100);
    openAndEmpty.insert(openAndEmpty.end(), {0x15, 0x05, 0, 0});
    Bytes out(1000);
    const Receiver toB = A.ReceiverOf(B);
    for (int i = 0; i < 3000; ++i)
    {
        for (const Bytes &message : {open, openAndEmpty})
        {
            const Sealer::Result result = A.Seals.SealPairwise(message, OuterClass::Traffic, toB, out);
            ASSERT_EQ(result.Fault, SealFault::None);
            ASSERT_EQ(result.Size, message.size() + 7);
        }
    }
}

TEST_F(SealStorm, NoDamagedDatagramOpens)
{
    std::mt19937_64 random(7);
    const auto below = [&random](std::size_t limit) { return static_cast<std::size_t>(random() % limit); };
    std::vector<Bytes> valid;
    for (int i = 0; i < 20; ++i)
    {
        const Bytes message = A.Message(4 * below(60) + 4);
        valid.push_back(A.ToAll(message));
        valid.push_back(A.ToAll(message, OuterClass::Meeting));
        valid.push_back(A.Pairwise(message, B, OuterClass::Bulletin));
        valid.push_back(A.Claims({B.NonceOf()}, i % 2 == 0));
        valid.push_back(C.ToAll(C.Message()));
        valid.push_back(C.Pairwise(C.Message(), B));
    }
    std::map<OpenFault, std::uint64_t> faults;
    TimePoint now = Start;
    const std::uint64_t count = Storm(200'000);
    for (std::uint64_t i = 0; i < count; ++i)
    {
        const Bytes &original = valid[below(valid.size())];
        Bytes damaged = original;
        for (std::size_t changes = 1 + below(3); changes > 0; --changes)
        {
            const Bytes &other = valid[below(valid.size())];
            switch (below(6))
            {
                case 0:
                    damaged[below(damaged.size())] ^= static_cast<std::uint8_t>(1 << below(8));
                    break;
                case 1:
                    damaged[below(std::min(damaged.size(), OuterSize))] = static_cast<std::uint8_t>(random());
                    break;
                case 2:
                    damaged.resize(1 + below(damaged.size()));
                    break;
                case 3:
                    damaged.insert(damaged.begin() + static_cast<std::ptrdiff_t>(below(damaged.size())),
                                   1 + below(40), static_cast<std::uint8_t>(random()));
                    break;
                case 4:  // the header of another datagram
                    std::copy_n(other.begin(), std::min(below(OuterSize + 1), damaged.size()),
                                damaged.begin());
                    break;
                default:  // the end of another datagram
                    std::copy_n(
                        other.end() - static_cast<std::ptrdiff_t>(std::min(other.size(), damaged.size()) / 2),
                        std::min(other.size(), damaged.size()) / 2,
                        damaged.end() -
                            static_cast<std::ptrdiff_t>(std::min(other.size(), damaged.size()) / 2));
                    break;
            }
        }
        if (std::find(valid.begin(), valid.end(), damaged) != valid.end())
        {
            continue;
        }
        const OpenFault fault = B.Fault(damaged, now);
        ASSERT_NE(fault, OpenFault::None) << "damaged datagram " << i;
        ++faults[fault];
    }
    // The damage reaches the deep checks, and leaves no trace: each datagram still opens, once.
    EXPECT_GT(faults[OpenFault::Malformed], 0u);
    EXPECT_GT(faults[OpenFault::UnknownSession], 0u);
    EXPECT_GT(faults[OpenFault::NotAuthentic], count / 4);
    EXPECT_EQ(faults[OpenFault::BadSignature], 0u);
    for (const Bytes &datagram : valid)
    {
        EXPECT_EQ(B.Fault(datagram, now), OpenFault::None);
        EXPECT_EQ(B.Fault(datagram, now), OpenFault::Replayed);
    }
}

}  // namespace
