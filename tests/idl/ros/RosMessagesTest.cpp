// The messages that are made of ROS 2's message packages.
#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <gtest/gtest.h>

#include <type_traits>

#include "made/msg/Both.idl.h"
#include "nav_msgs/msg/Odometry.idl.h"
#include "px4_msgs/msg/EscStatus.idl.h"
#include "px4_msgs/msg/VehicleOdometry.idl.h"
#include "shapes/msg/Bounded.idl.h"
#include "std_msgs/msg/Empty.idl.h"
#include "std_msgs/msg/Header.idl.h"

#if __has_include("nav_msgs/msg/Path.idl.h")
#error "a message that nobody asked for, nor is part of one"
#endif

namespace
{

std::vector<std::uint8_t> Encoded(const Rabit::RabitMessage &message)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    std::vector<std::uint8_t> bytes(type->SerializedSize(message));
    EXPECT_TRUE(type->Serialize(message, bytes));
    return bytes;
}

TEST(RosMessages, HaveTheirNamesInTheRegistry)
{
    for (const char *name : {"px4_msgs::msg::VehicleOdometry", "px4_msgs::msg::EscReport",
                             "std_msgs::msg::String", "made::msg::Both"})
    {
        EXPECT_NE(Rabit::MessageTypeRegistry::Find(name), nullptr) << name;
    }
}

// Hashes of ROS 2 Jazzy.
TEST(RosMessages, HaveTheHashesOfRos)
{
    const auto hashOf = [](const char *name)
    {
        const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Find(name);
        return type == nullptr ? "there is no such type" : type->RosTypeHash();
    };
    EXPECT_EQ(hashOf("std_msgs::msg::String"),
              "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18");
    EXPECT_EQ(hashOf("std_msgs::msg::Empty"),
              "RIHS01_20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312");
    EXPECT_EQ(hashOf("std_msgs::msg::Header"),
              "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01");
    EXPECT_EQ(hashOf("nav_msgs::msg::Odometry"),
              "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0");
}

TEST(RosMessages, HaveTheHashOfBoundsArraysAndPartsOfOtherPackages)
{
    EXPECT_EQ(shapes::msg::Bounded::IdlType().RosTypeHash(),
              "RIHS01_1fcd0973bff70910c653811e03283fd33f097838d02cf4dcbd2a42f25d7df0f9");
}

TEST(RosMessages, HaveConstantsInAModuleOfTheirOwn)
{
    static_assert(px4_msgs::msg::VehicleOdometry_Constants::POSE_FRAME_FRD == 2);
    namespace Shapes = shapes::msg::Bounded_Constants;
    EXPECT_EQ(Shapes::GREETING, "say \"hi\"");
    EXPECT_EQ(Shapes::HALF, 0.5F);
    EXPECT_EQ(Shapes::BIG, 1e10);
    EXPECT_EQ(Shapes::MOST, 18446744073709551615ULL);
    EXPECT_EQ(Shapes::LEAST, std::numeric_limits<std::int64_t>::min());
    EXPECT_TRUE(Shapes::YES);
    EXPECT_EQ(Shapes::MASK, 0xF0);
    EXPECT_EQ(Shapes::LETTER, 'A');
    EXPECT_EQ(made::msg::Pose_Constants::MASK, 7);
}

TEST(RosMessages, BeginWithTheDefaultsOfTheirFields)
{
    const shapes::msg::Bounded message;
    EXPECT_EQ(message.callsign, "uav #1");
    EXPECT_EQ(message.gain, 2.0F);
    EXPECT_TRUE(message.on);
    EXPECT_EQ(message.low, -7);
    EXPECT_EQ(made::msg::Pose().called, "none");
}

TEST(RosMessages, HaveArraysSequencesAndBounds)
{
    using Bounded = shapes::msg::Bounded;
    static_assert(
        std::is_same_v<decltype(px4_msgs::msg::EscStatus::esc), std::array<px4_msgs::msg::EscReport, 8>>);
    static_assert(
        std::is_same_v<decltype(nav_msgs::msg::Odometry().pose.covariance), std::array<double, 36>>);
    static_assert(std::is_same_v<decltype(made::msg::Pose::covariance), std::array<double, 36>>);
    static_assert(
        std::is_same_v<decltype(made::msg::Pose::corners), std::array<geometry_msgs::msg::Point, 2>>);
    static_assert(std::is_same_v<decltype(Bounded::tags), std::vector<std::string>>);
    static_assert(Bounded::few_bound == 3);
    Bounded message;
    message.callsign = "eleven char";
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    std::vector<std::uint8_t> bytes(type->SerializedSize(message));
    EXPECT_FALSE(type->Serialize(message, bytes));
}

// The bytes that every ROS 2 program sends for this message.
TEST(RosMessages, AreOnTheWireAsOfRos)
{
    std_msgs::msg::Header header;
    header.stamp.sec = 1;
    header.stamp.nanosec = 2;
    header.frame_id = "map";
    EXPECT_EQ(Encoded(header),
              (std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 4, 0, 0, 0, 'm', 'a', 'p', 0}));
    EXPECT_EQ(Encoded(std_msgs::msg::Empty()), (std::vector<std::uint8_t>{0, 1, 0, 3, 0, 0, 0, 0}));
}

TEST(RosMessages, ComeBackFromTheirBytes)
{
    made::msg::Both message;
    message.pose.covariance[35] = 7;
    message.pose.corners[1].z = 3;
    message.twist.tags = {"a", "b"};
    const std::vector<std::uint8_t> bytes = Encoded(message);
    made::msg::Both other;
    ASSERT_TRUE(Rabit::MessageTypeRegistry::Of(message)->Deserialize(bytes, other));
    EXPECT_EQ(other, message);
}

}  // namespace
