#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "mavlink/MavlinkFrame.h"
#include "mavlink/MavlinkMessages.h"

namespace Swarm
{
namespace
{

// Encodes a message in either version, and decodes it again.
template <typename Message>
void ExpectComesBack(const Message &message)
{
    for (const auto version : {MavlinkFrame::Version::One, MavlinkFrame::Version::Two})
    {
        MavlinkFrame frame = message.Encode();
        frame.Protocol = version;
        MavlinkParser parser;
        parser.Add(EncodeMavlink(frame));
        const auto arrived = parser.Next();
        ASSERT_TRUE(arrived);
        const auto decoded = Message::Decode(*arrived);
        ASSERT_TRUE(decoded);
        EXPECT_EQ(*decoded, message);
    }
}

TEST(MavlinkMessages, AHeartbeatComesBack)
{
    ExpectComesBack(
        MavlinkHeartbeat{.CustomMode = 4, .Type = 2, .Autopilot = 3, .BaseMode = 0x81, .SystemStatus = 4});
}

TEST(MavlinkMessages, AnAttitudeComesBack)
{
    ExpectComesBack(MavlinkAttitude{.TimeSinceBootMs = 4000000000u,
                                    .Roll = -0.5f,
                                    .Pitch = 0.25f,
                                    .Yaw = 3.0f,
                                    .RollSpeed = 1e-6f,
                                    .PitchSpeed = -2.0f,
                                    .YawSpeed = 0.0f});
}

TEST(MavlinkMessages, APositionOnTheOtherHalfOfTheEarthComesBack)
{
    ExpectComesBack(MavlinkGlobalPosition{.TimeSinceBootMs = 1,
                                          .LatitudeE7 = -337'500'000,
                                          .LongitudeE7 = -1'790'000'001,
                                          .AltitudeMm = -400,
                                          .RelativeAltitudeMm = 120'000,
                                          .NorthCmps = -1500,
                                          .EastCmps = 1501,
                                          .DownCmps = -3,
                                          .HeadingCdeg = 35999});
}

TEST(MavlinkMessages, APositionTargetComesBack)
{
    ExpectComesBack(MavlinkPositionTarget{.TimeSinceBootMs = 9,
                                          .LatitudeE7 = 473'977'000,
                                          .LongitudeE7 = 85'456'000,
                                          .AltitudeM = 520.5f,
                                          .TargetSystem = 3,
                                          .TargetComponent = 1});
}

TEST(MavlinkMessages, TheLengthsAreThoseOfTheDefinitions)
{
    EXPECT_EQ(MavlinkHeartbeat{}.Encode().Payload.size(), 9u);
    EXPECT_EQ(MavlinkAttitude{}.Encode().Payload.size(), 28u);
    EXPECT_EQ(MavlinkGlobalPosition{}.Encode().Payload.size(), 28u);
    EXPECT_EQ(MavlinkPositionTarget{}.Encode().Payload.size(), 53u);
}

TEST(MavlinkMessages, AFrameOfAnotherTypeIsNotDecoded)
{
    EXPECT_FALSE(MavlinkAttitude::Decode(MavlinkHeartbeat{}.Encode()));
}

TEST(MavlinkMessages, AShortPayloadIsFilledUpWithZeros)
{
    MavlinkFrame frame;
    frame.Message = MavlinkAttitude::Number;
    frame.Payload = {7};
    const auto attitude = MavlinkAttitude::Decode(frame);
    ASSERT_TRUE(attitude);
    EXPECT_EQ(*attitude, MavlinkAttitude{.TimeSinceBootMs = 7});
}

}  // namespace
}  // namespace Swarm
