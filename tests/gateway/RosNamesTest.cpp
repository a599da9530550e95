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

TEST(RosNames, ATopicOfLettersDigitsAndSlashesMayBe)
{
    for (const char *topic :
         {"chatter", "/chatter", "rt/fmu/out/vehicle_odometry_v1", "/uav1/_pose", "rr/addReply"})
    {
        EXPECT_EQ(WhyNoRosTopic(topic), "") << topic;
    }
}

TEST(RosNames, SaysWhyRosForbidsATopic)
{
    EXPECT_EQ(WhyNoRosTopic("/uav-1/pose"), "has `-`; ROS 2 allows A-Z a-z 0-9 _ /");
    EXPECT_EQ(WhyNoRosTopic("~/pose"), "has `~`; ROS 2 allows A-Z a-z 0-9 _ /");
    EXPECT_EQ(WhyNoRosTopic("/1/pose"), "has a part that begins with a digit");
    for (const char *topic : {"", "/", "/pose/", "//pose", "/uav1//pose"})
    {
        EXPECT_EQ(WhyNoRosTopic(topic), "has an empty part between slashes") << topic;
    }
}

}  // namespace
}  // namespace Rabit
