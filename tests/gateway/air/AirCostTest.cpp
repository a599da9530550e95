#include <gtest/gtest.h>
#include <rabit/gateway/AirCost.h>

namespace Rabit
{
namespace
{

TEST(AirCost, ASmallSampleCostsItsHeaders)
{
    // IPv4 and UDP, RTPS, INFO_TS, DATA, encapsulation.
    EXPECT_EQ(AirCost(1400).Of(100), 28u + 20 + 12 + 24 + 4 + 100);
}

TEST(AirCost, OneForASingleReaderNamesIt)
{
    EXPECT_EQ(AirCost(1400).Of(100, {1, true}), AirCost(1400).Of(100) + 16);
}

TEST(AirCost, EachDestinationCostsACopy)
{
    EXPECT_EQ(AirCost(1400).Of(100, {3, true}), 3 * AirCost(1400).Of(100, {1, true}));
    EXPECT_EQ(AirCost(1400).Of(5000, {3, true}), 3 * AirCost(1400).Of(5000, {1, true}));
}

TEST(AirCost, ABodyIsFilledUpToFourBytes)
{
    EXPECT_EQ(AirCost(1400).Of(97), AirCost(1400).Of(100));
    EXPECT_LT(AirCost(1400).Of(96), AirCost(1400).Of(97));
}

TEST(AirCost, WhatJustFillsADatagramGoesInOne)
{
    EXPECT_EQ(AirCost(1400).Of(1340), 28u + 1400);
    EXPECT_GT(AirCost(1400).Of(1344), 28u + 1404);
}

TEST(AirCost, WhatDoesNotFitGoesInFragmentsWithHeadersEach)
{
    // 4004 bytes, of which 1332 fit beside 20 + 12 + 36 bytes of headers: four datagrams.
    EXPECT_EQ(AirCost(1400).Of(4000), 4004u + 4 * (28 + 20 + 12 + 36));
    EXPECT_EQ(AirCost(1400).Of(4000, {1, true}), 4004u + 4 * (28 + 20 + 12 + 16 + 36));
}

TEST(AirCost, TheLargestBodyWithinACostHasThatCost)
{
    const AirCost cost(1400);
    EXPECT_EQ(cost.Of(cost.BodyWithin(400, true), {1, true}), 400u);
    EXPECT_EQ(cost.Of(cost.BodyWithin(400, false)), 400u);
    EXPECT_EQ(cost.BodyWithin(100'000, false), 1340u);
    EXPECT_EQ(cost.BodyWithin(60, false), 0u);
}

}  // namespace
}  // namespace Rabit
