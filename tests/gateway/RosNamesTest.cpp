#include <gtest/gtest.h>

#include "names/RosNames.h"

namespace Rabit
{
namespace
{

TEST(RosNames, ATopicIsBelowRt)
{
    EXPECT_EQ(RosTopicName("chatter"), "rt/chatter");
    EXPECT_EQ(RosTopicName("/chatter"), "rt/chatter");
    EXPECT_EQ(RosTopicName("/uav1/pose"), "rt/uav1/pose");
    EXPECT_EQ(RosTopicName(""), "rt/");
}

TEST(RosNames, ATopicOfTheWireStaysAsItIs)
{
    EXPECT_EQ(RosTopicName("rt/fmu/out/vehicle_odometry"), "rt/fmu/out/vehicle_odometry");
    EXPECT_EQ(RosTopicName("rr/addReply"), "rr/addReply");
    EXPECT_EQ(RosTopicName("/rt/chatter"), "rt/rt/chatter");
}

TEST(RosNames, ATypeIsInAModuleOfDdsAndEndsWithAnUnderscore)
{
    EXPECT_EQ(RosTypeName("std_msgs::msg::String"), "std_msgs::msg::dds_::String_");
    EXPECT_EQ(RosTypeName("Pose"), "dds_::Pose_");
    EXPECT_EQ(RosTypeName(""), "dds_::_");
}

TEST(RosNames, ATypeOfTheWireStaysAsItIs)
{
    EXPECT_EQ(RosTypeName("std_msgs::msg::dds_::String_"), "std_msgs::msg::dds_::String_");
    EXPECT_EQ(RosTypeName("odds_::String"), "odds_::dds_::String_");
}

}  // namespace
}  // namespace Rabit
