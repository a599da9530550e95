#include "PoseCount.h"

#include <gtest/gtest.h>

namespace
{
using Ground::PoseCount;

void Hear(PoseCount &count, std::uint32_t first, std::uint32_t last)
{
    for (std::uint32_t number = first; number <= last; ++number)
        count.OnPose(number);
}

TEST(PoseCount, CountsNothingBeforeTwoMissionStates)
{
    PoseCount count;
    Hear(count, 5, 10);
    count.OnMissionState(10);
    EXPECT_EQ(count.Published(), 0u);
    EXPECT_EQ(count.Heard(), 0u);
}

TEST(PoseCount, CountsEveryPoseBetweenTheFirstAndTheLastMissionState)
{
    PoseCount count;
    Hear(count, 5, 10);
    count.OnMissionState(10);
    Hear(count, 11, 30);
    count.OnMissionState(30);
    EXPECT_EQ(count.Published(), 20u);
    EXPECT_EQ(count.Heard(), 20u);
}

TEST(PoseCount, NoticesMissingPoses)
{
    PoseCount count;
    Hear(count, 1, 10);
    count.OnMissionState(10);
    Hear(count, 13, 20);
    count.OnMissionState(25);
    EXPECT_EQ(count.Published(), 15u);
    EXPECT_EQ(count.Heard(), 8u);
}

TEST(PoseCount, DoesNotCountWhatWasPublishedBeforeTheFirstPoseHeard)
{
    PoseCount count;
    count.OnMissionState(40);  // kept for late joiners, from before the connection
    Hear(count, 100, 110);
    count.OnMissionState(40);  // repeated
    count.OnMissionState(110);
    Hear(count, 111, 120);
    count.OnMissionState(120);
    EXPECT_EQ(count.Published(), 10u);
    EXPECT_EQ(count.Heard(), 10u);
}

TEST(PoseCount, CountsPosesThatOvertakeTheirMissionState)
{
    PoseCount count;
    Hear(count, 1, 13);
    count.OnMissionState(10);
    Hear(count, 14, 25);
    count.OnMissionState(20);
    EXPECT_EQ(count.Published(), 10u);
    EXPECT_EQ(count.Heard(), 10u);
}

TEST(PoseCount, CountsPosesThatArriveAfterTheirMissionState)
{
    PoseCount count;
    Hear(count, 1, 8);
    count.OnMissionState(10);
    Hear(count, 9, 18);
    count.OnMissionState(20);
    Hear(count, 19, 20);
    EXPECT_EQ(count.Published(), 10u);
    EXPECT_EQ(count.Heard(), 10u);
}

TEST(PoseCount, CountsARepeatedPoseOnce)
{
    PoseCount count;
    Hear(count, 1, 1);
    count.OnMissionState(1);
    count.OnPose(2);
    count.OnPose(2);
    count.OnMissionState(3);
    EXPECT_EQ(count.Published(), 2u);
    EXPECT_EQ(count.Heard(), 1u);
}

TEST(PoseCount, SeesSilenceAsMissingPoses)
{
    PoseCount count;
    Hear(count, 1, 10);
    count.OnMissionState(10);
    count.OnMissionState(20);
    count.OnMissionState(30);
    EXPECT_EQ(count.Published(), 20u);
    EXPECT_EQ(count.Heard(), 0u);
}

TEST(PoseCount, AddsUpTheLivesOfAnAircraftThatRestarts)
{
    PoseCount count;
    Hear(count, 1, 10);
    count.OnMissionState(10);
    Hear(count, 11, 20);
    count.OnMissionState(20);  // 10 of 10
    Hear(count, 1, 5);
    count.OnMissionState(5);
    Hear(count, 6, 8);
    count.OnMissionState(10);  // 3 of 5
    EXPECT_EQ(count.Published(), 15u);
    EXPECT_EQ(count.Heard(), 13u);
}

TEST(PoseCount, NoticesARestartByTheMissionStateToo)
{
    PoseCount count;
    Hear(count, 1, 10);
    count.OnMissionState(10);
    Hear(count, 11, 20);
    count.OnMissionState(20);
    count.OnMissionState(0);
    Hear(count, 1, 3);
    count.OnMissionState(3);
    Hear(count, 4, 6);
    count.OnMissionState(6);
    EXPECT_EQ(count.Published(), 13u);
    EXPECT_EQ(count.Heard(), 13u);
}

}  // namespace
