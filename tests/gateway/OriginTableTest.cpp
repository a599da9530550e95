#include "presence/OriginTable.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

// A node whose source clock was 1000 s ahead and stood still for 60 s when it showed 1020 s.
const OriginTable::Origin AfterAStandstill{
    .Incarnation = 1,
    .Source = {.ToLocal = -940s, .StoodStill = 60s, .StoodStillUntil = 1020s},
    .SourceToWall = 0s};

TEST(OriginTable, WhatWasPostedAfterAStandstillIsAsYoungAsItIs)
{
    EXPECT_EQ(AfterAStandstill.PostedAt(Ns(1025s).count(), 86s), Ns(85s));
}

TEST(OriginTable, WhatWasPostedBeforeAStandstillAndComesAgainIsAsOldAsItIs)
{
    EXPECT_EQ(AfterAStandstill.PostedAt(Ns(1019s).count(), 86s), Ns(19s));
}

TEST(OriginTable, AFormerIncarnationDoesNotComeBackWhicheverIsHigher)
{
    OriginTable origins;
    const auto incarnationAfter = [&origins](std::uint64_t heard)
    {
        OriginTable::Origin origin = AfterAStandstill;
        origin.Incarnation = heard;
        origins.Set("uav1", origin);
        return origins.Find("uav1")->Incarnation;
    };
    EXPECT_EQ(incarnationAfter(7), 7U);
    EXPECT_EQ(incarnationAfter(9), 9U);
    EXPECT_EQ(incarnationAfter(7), 9U);
    EXPECT_EQ(incarnationAfter(4), 4U) << "a restart after the clock was put back";
    EXPECT_EQ(incarnationAfter(9), 4U);
    EXPECT_EQ(incarnationAfter(7), 4U);
    origins.Forget("uav1");
    EXPECT_EQ(incarnationAfter(7), 7U);
}

}  // namespace
}  // namespace Rabit
