#include "mission/Floor.h"

#include <gtest/gtest.h>

namespace
{
using Swarm::Floor;

TEST(Floor, LetsEverythingPassWhenThereIsNone)
{
    EXPECT_FALSE(Floor().LowestM());
    EXPECT_EQ(Floor().WhyTooLow(-400), "");
    EXPECT_EQ(Floor().Raised(-400), -400);
}

TEST(Floor, IsAHeightAboveSeaLevel)
{
    const Floor floor({.AboveSeaM = 100});
    EXPECT_EQ(floor.LowestM(), 100);
    EXPECT_EQ(floor.WhyTooLow(100), "");
    EXPECT_EQ(floor.WhyTooLow(99.5), "99.5 m above sea level is below the floor of 100 m");
}

TEST(Floor, IsAClearanceAboveTheGround)
{
    const Floor floor({.GroundM = 430, .ClearanceM = 30});
    EXPECT_EQ(floor.LowestM(), 460);
    EXPECT_EQ(floor.WhyTooLow(460), "");
    EXPECT_EQ(floor.WhyTooLow(50),
              "50 m above sea level is 380 m below the ground and below the floor of 460 m");
    EXPECT_EQ(floor.WhyTooLow(440),
              "440 m above sea level is 10 m above the ground and below the floor of 460 m");
}

TEST(Floor, HasNoClearanceWhereTheGroundIsNotKnown)
{
    EXPECT_FALSE(Floor({.ClearanceM = 30}).LowestM());
}

TEST(Floor, IsTheHigherOfBoth)
{
    EXPECT_EQ(Floor({.AboveSeaM = 500, .GroundM = 430, .ClearanceM = 30}).LowestM(), 500);
    EXPECT_EQ(Floor({.AboveSeaM = 450, .GroundM = 430, .ClearanceM = 30}).LowestM(), 460);
}

TEST(Floor, MayBeBelowTheSea)
{
    EXPECT_EQ(Floor({.GroundM = -400, .ClearanceM = 30}).LowestM(), -370);
}

TEST(Floor, TakesAnAltitudeThatCameThroughAFloatForWhatItWas)
{
    EXPECT_EQ(Floor({.AboveSeaM = 460.3}).WhyTooLow(460.3F), "");
}

TEST(Floor, RaisesWhatIsBelowIt)
{
    const Floor floor({.AboveSeaM = 100});
    EXPECT_EQ(floor.Raised(20), 100);
    EXPECT_EQ(floor.Raised(120), 120);
}

TEST(Floor, SaysWhyInWhatAnAnswerTakes)
{
    const Floor floor({.AboveSeaM = 9999.9, .GroundM = 8999.9, .ClearanceM = 999.9});
    EXPECT_LE(("search area: " + floor.WhyTooLow(-499.9)).size(), 128u);
}
}  // namespace
