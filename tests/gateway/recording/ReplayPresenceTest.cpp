#include "recording/replay/ReplayPresence.h"

#include <gtest/gtest.h>

namespace Rabit::Replay
{
namespace
{

constexpr Time Second = 1'000'000'000;

// uav1 recorded itself and its knowledge of the others; ground likewise.
class ReplayPresenceTest : public ::testing::Test
{
protected:
    ReplayPresence presence{{"uav1", "ground"}};
};

TEST_F(ReplayPresenceTest, NobodyIsThereOfWhomNothingWasRecorded)
{
    EXPECT_FALSE(presence.IsThere("uav1", 100 * Second));
    EXPECT_FALSE(presence.IsThere("uav2", 100 * Second));
}

TEST_F(ReplayPresenceTest, ARecorderIsThereUntilItHasBeenSilent)
{
    presence.Told("uav1", "Gateway", 100 * Second, {});
    EXPECT_TRUE(presence.IsThere("uav1", 103 * Second));
    EXPECT_FALSE(presence.IsThere("uav1", 104 * Second));
    presence.Told("uav1", "Gateway", 110 * Second, {});
    EXPECT_TRUE(presence.IsThere("uav1", 110 * Second)) << "its next life";
}

TEST_F(ReplayPresenceTest, ARecorderThatRecordsAnythingIsThere)
{
    presence.Told("uav1", "Gateway", 100 * Second, {});
    presence.Heard("uav2", "uav1", 104 * Second);
    EXPECT_TRUE(presence.IsThere("uav1", 105 * Second));
}

TEST_F(ReplayPresenceTest, AnotherNodeIsThereUntilTheRecorderLostIt)
{
    presence.Told("uav1", "Gateway", 100 * Second, {{"uav2", false}});
    EXPECT_TRUE(presence.IsThere("uav2", 100 * Second));
    presence.Told("uav1", "Gateway", 101 * Second, {{"uav2", true}});
    EXPECT_FALSE(presence.IsThere("uav2", 101 * Second));
    presence.Told("uav1", "Gateway", 102 * Second, {{"uav2", false}});
    EXPECT_TRUE(presence.IsThere("uav2", 102 * Second));
}

TEST_F(ReplayPresenceTest, WhomOneRecorderHeardIsThereAlthoughAnotherLostIt)
{
    presence.Told("uav1", "Gateway", 100 * Second, {{"uav2", true}});
    presence.Told("ground", "Gateway", 100 * Second, {{"uav2", false}});
    EXPECT_TRUE(presence.IsThere("uav2", 101 * Second));
}

TEST_F(ReplayPresenceTest, WhomOneGatewayOfARecorderHeardIsThereAlthoughItsOtherOneLostIt)
{
    presence.Told("uav1", "Gateway", 100 * Second, {{"uav2", false}});
    presence.Told("uav1", "Radio", 100 * Second, {{"uav2", true}});
    EXPECT_TRUE(presence.IsThere("uav2", 101 * Second));
}

TEST_F(ReplayPresenceTest, WhatARecorderKnewEndsWithIt)
{
    presence.Told("uav1", "Gateway", 100 * Second, {{"uav2", false}});
    EXPECT_FALSE(presence.IsThere("uav2", 104 * Second));
}

TEST_F(ReplayPresenceTest, ANodeOfWhichNobodyToldIsThereOnceItsMessageCame)
{
    presence.Heard("uav3", "fleet", 100 * Second);
    EXPECT_TRUE(presence.IsThere("uav3", 1000 * Second));
}

TEST_F(ReplayPresenceTest, ANodeThatWasLostIsThereWhenItsMessageComes)
{
    presence.Told("uav1", "Gateway", 100 * Second, {{"uav2", true}});
    presence.Heard("uav2", "uav1", 100 * Second + 1);
    EXPECT_TRUE(presence.IsThere("uav2", 101 * Second));
    presence.Told("uav1", "Gateway", 101 * Second, {{"uav2", true}});
    EXPECT_FALSE(presence.IsThere("uav2", 101 * Second));
}

TEST_F(ReplayPresenceTest, AfterAJumpNothingOfBeforeHolds)
{
    presence.Told("uav1", "Gateway", 100 * Second, {{"uav2", false}});
    presence.Heard("uav3", "uav1", 100 * Second);
    presence.Reset();
    for (const char *node : {"uav1", "uav2", "uav3"})
    {
        EXPECT_FALSE(presence.IsThere(node, 100 * Second)) << node;
    }
}

}  // namespace
}  // namespace Rabit::Replay
