#include "Names.h"

#include <gtest/gtest.h>

namespace
{
using Swarm::Names;

TEST(Names, OfTheLocalNodeArePlain)
{
    const Names names("uav1", "uav1");
    EXPECT_EQ(names.Own("Pose"), "Pose");
    EXPECT_EQ(names.OwnVision("Targets"), "uav1.vision/Targets");
    EXPECT_EQ(names.Of("uav2", "MissionControl"), "uav2/MissionControl");
}

TEST(Names, OfTheVisionNodeArePlainInItsProcess)
{
    const Names names("uav1", "uav1.vision");
    EXPECT_EQ(names.Own("Pose"), "uav1/Pose");
    EXPECT_EQ(names.OwnVision("Targets"), "Targets");
}

TEST(Names, AreAllFullWithoutALocalNode)
{
    const Names names("uav1", "");
    EXPECT_EQ(names.Own("Pose"), "uav1/Pose");
    EXPECT_EQ(names.OwnVision("Targets"), "uav1.vision/Targets");
}

TEST(Names, MayEndWithANumber)
{
    EXPECT_EQ(Names::NumberOf("uav7"), 7);
    EXPECT_EQ(Names::NumberOf("uav012"), 12);
    EXPECT_EQ(Names::NumberOf("north"), 0);
    EXPECT_EQ(Names::NumberOf("uav99999999999999999999"), 999);
    EXPECT_EQ(Names::NumberOf(""), 0);
    EXPECT_EQ(Names::NumberOf("12"), 12);
}

}  // namespace
