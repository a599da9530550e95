// Whether a submessage that carries a sample, or manages its delivery, is consistent in itself.
#include "guard/DeliveryCheck.h"

#include <gtest/gtest.h>

#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::Rtps::LargestSequence;

bool IsSound(std::uint8_t kind, const Bytes &body, std::uint8_t flags = 1)
{
    Bytes message = Message(kind, body, flags);
    auto rest = std::span(message).subspan(Rabit::Rtps::RtpsHeaderSize);
    const auto submessage = Rabit::Rtps::TakeSubmessage(rest);
    return submessage && Rabit::Rtps::CheckDelivery(*submessage).has_value();
}

TEST(DeliveryCheck, SoundSubmessagesPass)
{
    EXPECT_TRUE(IsSound(Data, DataBody(1), 5));
    EXPECT_TRUE(IsSound(DataFrag, FragmentBody(3, 1, 1000, 2500, 500)));
    EXPECT_TRUE(IsSound(DataFrag, FragmentBody(1, 2, 1000, 2500, 2000)));
    EXPECT_TRUE(IsSound(Heartbeat, HeartbeatBody(1, 0, 1)));
    EXPECT_TRUE(IsSound(AckNack, AckNackBody(1, 256, 1)));
    EXPECT_TRUE(IsSound(Gap, GapBody(3, 5)));
    EXPECT_TRUE(IsSound(NackFrag, NackFragBody(1, 1, 40, 1)));
}

TEST(DeliveryCheck, EveryTruncationIsUnsound)
{
    const std::vector<std::pair<std::uint8_t, Bytes>> whole = {{Data, DataBody(1, {0, 1, 0, 0})},
                                                               {DataFrag, FragmentBody(1, 1, 64, 64, 64)},
                                                               {Heartbeat, HeartbeatBody(1, 1, 1)},
                                                               {AckNack, AckNackBody(1, 32, 1)},
                                                               {Gap, GapBody(3, 5, 32)},
                                                               {NackFrag, NackFragBody(1, 1, 32, 1)}};
    for (const auto &[kind, body] : whole)
    {
        ASSERT_TRUE(IsSound(kind, body, 5 & (kind == Data ? 5 : 1))) << int{kind};
        // Begins at 1: a submessage of length 0 extends to the end of the message.
        for (std::size_t size = 1; size < body.size(); ++size)
        {
            EXPECT_FALSE(IsSound(kind, Bytes(body.begin(), body.begin() + static_cast<std::ptrdiff_t>(size)),
                                 kind == Data ? 5 : 1))
                << int{kind} << " of " << size;
        }
    }
}

TEST(DeliveryCheck, ImpossibleNumbersAreUnsound)
{
    for (const std::int64_t number :
         {std::int64_t{0}, std::int64_t{-1}, LargestSequence, INT64_MIN, INT64_MAX})
    {
        EXPECT_FALSE(IsSound(Data, DataBody(number), 5)) << number;
        EXPECT_FALSE(IsSound(Heartbeat, HeartbeatBody(number, number, 1))) << number;
        EXPECT_FALSE(IsSound(Gap, GapBody(number, number))) << number;
    }
    EXPECT_FALSE(IsSound(Heartbeat, HeartbeatBody(5, 3, 1)));
    EXPECT_FALSE(IsSound(AckNack, AckNackBody(-1, 0, 1)));
    EXPECT_FALSE(IsSound(AckNack, AckNackBody(LargestSequence, 1, 1)));
    EXPECT_FALSE(IsSound(NackFrag, NackFragBody(1, 0, 1, 1)));
}

TEST(DeliveryCheck, AGapBackwardsIsUnsound)
{
    EXPECT_FALSE(IsSound(Gap, GapBody(5, 3)));
    EXPECT_TRUE(IsSound(Gap, GapBody(5, 5)));
}

TEST(DeliveryCheck, ASetOfMoreThan256OrWithoutItsWordsIsUnsound)
{
    EXPECT_FALSE(IsSound(AckNack, AckNackBody(1, 257, 1)));
    EXPECT_FALSE(IsSound(AckNack, Join({Ids(UserReader), Sequence(1), U32(256), U32(1)})));
    EXPECT_FALSE(IsSound(Gap, GapBody(3, 5, 257)));
    EXPECT_FALSE(IsSound(NackFrag, NackFragBody(1, 1, 257, 1)));
}

TEST(DeliveryCheck, FragmentsThatDoNotFitTheirSampleAreUnsound)
{
    EXPECT_FALSE(IsSound(DataFrag, FragmentBody(4, 1, 1000, 2500, 1000)));
    EXPECT_FALSE(IsSound(DataFrag, FragmentBody(3, 2, 1000, 2500, 2000)));
    EXPECT_FALSE(IsSound(DataFrag, FragmentBody(0, 1, 1000, 2500, 1000)));
    EXPECT_FALSE(IsSound(DataFrag, FragmentBody(1, 0, 1000, 2500, 1000)));
    EXPECT_FALSE(IsSound(DataFrag, FragmentBody(1, 1, 0, 2500, 1000)));
    EXPECT_FALSE(IsSound(DataFrag, FragmentBody(1, 1, 1000, 0, 1000)));
    EXPECT_FALSE(IsSound(DataFrag, FragmentBody(1, 1, 1000, 0xffffffff, 1000)));
}

// The vendor copies as many bytes as the last fragment must have, however many arrived.
TEST(DeliveryCheck, FragmentsWithFewerBytesThanTheyPromiseAreUnsound)
{
    EXPECT_FALSE(IsSound(DataFrag, FragmentBody(3, 1, 1000, 2500, 499)));
    EXPECT_FALSE(IsSound(DataFrag, FragmentBody(1, 2, 1000, 2500, 1999)));
}

TEST(DeliveryCheck, FragmentsTooSmallToBeOfUseAreUnsound)
{
    EXPECT_TRUE(IsSound(DataFrag, FragmentBody(1, 1, 64, 2500, 64)));
    EXPECT_FALSE(IsSound(DataFrag, FragmentBody(1, 1, 63, 2500, 64)));
}

TEST(DeliveryCheck, AnInlineQosThatDoesNotEndIsUnsound)
{
    const Bytes sound = {0x71, 0, 4, 0, 0, 0, 0, 1, 1, 0, 0, 0};
    EXPECT_TRUE(IsSound(Data, DataBody(1, sound), 3));
    EXPECT_FALSE(IsSound(Data, DataBody(1, {0x71, 0, 4, 0, 0, 0, 0, 1}), 3));
    EXPECT_FALSE(IsSound(Data, DataBody(1, {0x71, 0, 40, 0, 0, 0, 0, 1, 1, 0, 0, 0}), 3));
    EXPECT_TRUE(IsSound(Data, DataBody(1, Join({Bytes(4 * 62), sound})), 3));
    EXPECT_FALSE(IsSound(Data, DataBody(1, Join({Bytes(4 * 63), sound})), 3));
}

TEST(DeliveryCheck, AnInlineParameterOfAnotherSizeThanItsOwnIsUnsound)
{
    const auto with = [](const Bytes &parameter) {
        return Join({parameter, Parameter(0x0071, {0, 0, 0, 1}), {1, 0, 0, 0}});
    };
    EXPECT_TRUE(IsSound(Data, DataBody(1, with(Parameter(0x0070, Bytes(16)))), 3));
    EXPECT_FALSE(IsSound(Data, DataBody(1, with(Parameter(0x0070, Bytes(12)))), 3));
    EXPECT_FALSE(IsSound(Data, DataBody(1, with(Parameter(0x0071, Bytes(8)))), 3));
    EXPECT_FALSE(IsSound(Data, DataBody(1, with(Parameter(0x800f, Bytes(28)))), 3));
}

TEST(DeliveryCheck, TheSampleBeginsWhereTheProtocolHasIt)
{
    const auto at = [](std::uint8_t toInlineQos) {
        return Join({{0, 0, toInlineQos, 0}, Ids(), Sequence(1), Bytes(40)});
    };
    EXPECT_TRUE(IsSound(Data, at(16), 5));
    EXPECT_FALSE(IsSound(Data, at(12), 5));
    EXPECT_FALSE(IsSound(Data, at(20), 5));
}

TEST(DeliveryCheck, ASampleWithoutAValueIsUnsoundUnlessItIsDisposed)
{
    EXPECT_FALSE(IsSound(Data, DataBody(1, {}), 1));
    EXPECT_FALSE(IsSound(Data, DataBody(1, {1, 0, 0, 0}), 3));
    EXPECT_TRUE(IsSound(Data, DataBody(1, Join({Parameter(0x0071, {0, 0, 0, 3}), {1, 0, 0, 0}})), 3));
}

TEST(DeliveryCheck, ASampleThatIsAKeyAsWellIsUnsound)
{
    EXPECT_FALSE(IsSound(Data, DataBody(1), 13));
}

TEST(DeliveryCheck, EntitiesOfTheWrongKindAreUnsound)
{
    EXPECT_FALSE(IsSound(Heartbeat, HeartbeatBody(1, 1, 1, UserReader)));
    EXPECT_FALSE(IsSound(Data, DataBody(1, Bytes(8), UserWriter, UserWriter), 5));
    // Each topic of discovery has a reader and a writer of its own.
    EXPECT_FALSE(IsSound(Data, DataBody(1, Bytes(8), UserWriter, 0x000003c7), 5));
    EXPECT_FALSE(IsSound(Data, DataBody(1, Bytes(8), 0x000003c2, UserReader), 5));
    EXPECT_FALSE(IsSound(Data, DataBody(1, Bytes(8), 0x000003c2, 0x000004c7), 5));
    EXPECT_TRUE(IsSound(Data, DataBody(1, Bytes(8), 0x000003c2, 0x000003c7), 5));
}

}  // namespace
