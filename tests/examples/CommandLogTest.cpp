#include "CommandLog.h"

#include <gtest/gtest.h>

namespace
{
using Answer = Ground::CommandLog::Answer;
using Ground::CommandLog;

TEST(CommandLog, NumbersCommandsFromOne)
{
    CommandLog log;
    EXPECT_EQ(log.NextId(), 1u);
    EXPECT_EQ(log.Sent("uav1", 0), 1u);
    EXPECT_EQ(log.Sent("uav2", 0), 2u);
    EXPECT_EQ(log.NextId(), 3u);
}

TEST(CommandLog, DoesNotUseUpANumberForARefusedCommand)
{
    CommandLog log;
    log.Refused("uav1");
    EXPECT_EQ(log.NextId(), 1u);
    EXPECT_EQ(log.Of("uav1").Refused, 1u);
    EXPECT_EQ(log.Of("uav1").Sent, 0u);
    EXPECT_TRUE(log.Outstanding().empty());
}

TEST(CommandLog, ListsWhatWaitsForItsAnswer)
{
    CommandLog log;
    log.Sent("uav1", 1.5);
    log.Sent("uav2", 2.5);
    log.Sent("uav1", 3.5);
    log.Acknowledged(2, "uav2", true);
    const auto outstanding = log.Outstanding();
    ASSERT_EQ(outstanding.size(), 2u);
    EXPECT_EQ(outstanding[0].Id, 1u);
    EXPECT_EQ(outstanding[0].Node, "uav1");
    EXPECT_EQ(outstanding[0].SentAtS, 1.5);
    EXPECT_EQ(outstanding[1].Id, 3u);
}

TEST(CommandLog, CountsAnAnswerForItsAircraft)
{
    CommandLog log;
    log.Sent("uav1", 0);
    log.Sent("uav1", 0);
    EXPECT_EQ(log.Acknowledged(1, "uav1", true), Answer::Counted);
    EXPECT_EQ(log.Acknowledged(2, "uav1", false), Answer::Counted);
    EXPECT_EQ(log.Of("uav1").Sent, 2u);
    EXPECT_EQ(log.Of("uav1").Acknowledged, 2u);
    EXPECT_EQ(log.Of("uav1").Declined, 1u);
}

TEST(CommandLog, DoesNotTakeTheAnswerOfAnotherAircraft)
{
    CommandLog log;
    log.Sent("uav1", 0);
    EXPECT_EQ(log.Acknowledged(1, "uav2", true), Answer::WrongNode);
    EXPECT_EQ(log.WrongNode(), 1u);
    EXPECT_EQ(log.Of("uav1").Acknowledged, 0u);
    EXPECT_EQ(log.Of("uav2").Acknowledged, 0u);
    EXPECT_EQ(log.Outstanding().size(), 1u);
}

TEST(CommandLog, CountsARepeatedAnswerOnce)
{
    CommandLog log;
    log.Sent("uav1", 0);
    log.Acknowledged(1, "uav1", true);
    EXPECT_EQ(log.Acknowledged(1, "uav1", true), Answer::Repeated);
    EXPECT_EQ(log.Repeated(), 1u);
    EXPECT_EQ(log.Of("uav1").Acknowledged, 1u);
}

TEST(CommandLog, KnowsAnswersToCommandsThatItNeverSent)
{
    CommandLog log;
    log.Sent("uav1", 0);
    EXPECT_EQ(log.Acknowledged(0, "uav1", true), Answer::Unknown);
    EXPECT_EQ(log.Acknowledged(2, "uav1", true), Answer::Unknown);
    EXPECT_EQ(log.Unknown(), 2u);
}

}  // namespace
