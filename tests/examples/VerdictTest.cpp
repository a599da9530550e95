#include "Verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace
{
using Ground::AircraftResult;
using Ground::CommandLog;
using Ground::Judge;
using Ground::RowState;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

AircraftResult Good(const CommandLog &log)
{
    return {"uav1", RowState::Up, 100, 95, log.Of("uav1")};
}

// One command, sent and acknowledged.
CommandLog Answered()
{
    CommandLog log;
    log.Sent("uav1", 1);
    log.Acknowledged(1, "uav1", true);
    return log;
}

TEST(Verdict, PassesWhenEverythingWasHeardAndAcknowledged)
{
    const CommandLog log = Answered();
    const auto verdict = Judge({Good(log)}, log, 30);
    EXPECT_THAT(verdict.Failures, IsEmpty());
    EXPECT_THAT(
        verdict.Summary,
        ElementsAre("Summary after 30.0 s",
                    "  uav1  UP  heard 95 of 100 poses (95.0 %), commands 1 sent 1 acknowledged", "Passed"));
}

TEST(Verdict, PassesAtExactlyTheRequiredShare)
{
    AircraftResult result = Good(Answered());
    result.Heard = 90;
    EXPECT_TRUE(Judge({result}, Answered(), 30).Passed());
}

TEST(Verdict, FailsBelowTheRequiredShare)
{
    AircraftResult result = Good(Answered());
    result.Heard = 89;
    EXPECT_THAT(Judge({result}, Answered(), 30).Failures,
                ElementsAre("uav1: only 89.0 % of its poses were heard, not 90.0 %"));
}

TEST(Verdict, FailsWithoutPosesToJudge)
{
    AircraftResult result = Good(Answered());
    result.Published = result.Heard = 0;
    EXPECT_THAT(Judge({result}, Answered(), 30).Failures,
                ElementsAre("uav1: no poses to judge, it was not heard for long enough"));
}

TEST(Verdict, FailsWithoutAircraft)
{
    EXPECT_THAT(Judge({}, {}, 30).Failures, ElementsAre("no aircraft was heard"));
}

TEST(Verdict, FailsWhenAnAircraftIsLostAtTheEnd)
{
    AircraftResult result = Good(Answered());
    result.State = RowState::Lost;
    EXPECT_THAT(Judge({result}, Answered(), 30).Failures, ElementsAre("uav1 was LOST at the end"));
}

TEST(Verdict, FailsForACommandWithoutAnswerAndNamesIt)
{
    CommandLog log;
    log.Sent("uav1", 12.25);
    const auto verdict = Judge({Good(log)}, log, 30);
    EXPECT_THAT(verdict.Failures, ElementsAre("command 1 to uav1, sent at 12.2 s, was not acknowledged"));
    EXPECT_EQ(verdict.Summary.back(), "Failed");
    EXPECT_THAT(verdict.Summary, testing::Contains(HasSubstr("FAILED: command 1 to uav1")));
}

TEST(Verdict, FailsForAnAnswerOfTheWrongAircraft)
{
    CommandLog log;
    log.Sent("uav1", 1);
    log.Acknowledged(1, "uav2", true);
    log.Acknowledged(1, "uav1", true);
    EXPECT_THAT(Judge({Good(log)}, log, 30).Failures,
                ElementsAre("1 acknowledgements came from the wrong aircraft"));
}

TEST(Verdict, FailsForARepeatedAnswer)
{
    CommandLog log = Answered();
    log.Acknowledged(1, "uav1", true);
    EXPECT_THAT(Judge({Good(log)}, log, 30).Failures, ElementsAre("1 acknowledgements came more than once"));
}

TEST(Verdict, FailsForAnAircraftThatWasNeverSentACommand)
{
    CommandLog log;
    log.Refused("uav1");
    AircraftResult result = Good(log);
    EXPECT_THAT(Judge({result}, log, 30).Failures, ElementsAre("uav1: no command was sent to it"));
}

TEST(Verdict, PassesWhenARefusedCommandWasSentLater)
{
    CommandLog log;
    log.Refused("uav1");
    log.Sent("uav1", 1);
    log.Acknowledged(1, "uav1", true);
    EXPECT_TRUE(Judge({Good(log)}, log, 30).Passed());
}

TEST(Verdict, TellsOfDeclinedAndRefusedCommands)
{
    CommandLog log;
    log.Refused("uav1");
    log.Sent("uav1", 1);
    log.Acknowledged(1, "uav1", false);
    EXPECT_THAT(Judge({Good(log)}, log, 30).Summary,
                testing::Contains(HasSubstr("1 sent 1 acknowledged, 1 declined, 1 refused for sending")));
}

TEST(Verdict, OnlyReportsAnswersToTheCommandsOfAnotherRun)
{
    CommandLog log = Answered();
    log.Acknowledged(7, "uav1", true);
    const auto verdict = Judge({Good(log)}, log, 30);
    EXPECT_TRUE(verdict.Passed());
    EXPECT_THAT(verdict.Summary,
                testing::Contains(HasSubstr("1 acknowledgements of commands that this ground")));
}

}  // namespace
