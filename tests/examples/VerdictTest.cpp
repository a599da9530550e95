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

const Ground::Demands CommandUav1{.Commanded = {"uav1"}};

Ground::CommandStatus ToUav1()
{
    Ground::CommandStatus command;
    command.node = "uav1";
    return command;
}

Uav::CommandAck Ack(std::uint32_t id, const std::string &node,
                    Uav::CommandStage stage = Uav::CommandStage::COMMAND_ACCEPTED)
{
    Uav::CommandAck ack;
    ack.id = id;
    ack.node = node;
    ack.stage = stage;
    return ack;
}

AircraftResult Good(const CommandLog &log)
{
    return {"uav1", RowState::Up, 100, 95, log.Of("uav1"), {}};
}

// A log with one command, sent and acknowledged.
CommandLog Answered()
{
    CommandLog log;
    log.Sent(ToUav1(), 1);
    log.Answered(Ack(1, "uav1"), 2);
    return log;
}

TEST(Verdict, PassesWhenEverythingWasHeardAndAcknowledged)
{
    const CommandLog log = Answered();
    const auto verdict = Judge({Good(log)}, log, CommandUav1, 30);
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
    EXPECT_TRUE(Judge({result}, Answered(), CommandUav1, 30).Passed());
}

TEST(Verdict, FailsBelowTheRequiredShare)
{
    AircraftResult result = Good(Answered());
    result.Heard = 89;
    EXPECT_THAT(Judge({result}, Answered(), CommandUav1, 30).Failures,
                ElementsAre("uav1: only 89.0 % of its poses were heard, not 90.0 %"));
}

TEST(Verdict, FailsWithoutPosesToJudge)
{
    AircraftResult result = Good(Answered());
    result.Published = result.Heard = 0;
    EXPECT_THAT(Judge({result}, Answered(), CommandUav1, 30).Failures,
                ElementsAre("uav1: no poses to judge, it was not heard for long enough"));
}

TEST(Verdict, FailsWithoutAircraft)
{
    EXPECT_THAT(Judge({}, CommandLog(), CommandUav1, 30).Failures, ElementsAre("no aircraft was heard"));
}

TEST(Verdict, FailsWhenAnAircraftIsLostAtTheEnd)
{
    AircraftResult result = Good(Answered());
    result.State = RowState::Lost;
    EXPECT_THAT(Judge({result}, Answered(), CommandUav1, 30).Failures,
                ElementsAre("uav1 was LOST at the end"));
}

TEST(Verdict, FailsForACommandWithoutAnswerAndNamesIt)
{
    CommandLog log;
    log.Sent(ToUav1(), 12.25);
    const auto verdict = Judge({Good(log)}, log, CommandUav1, 30);
    EXPECT_THAT(verdict.Failures, ElementsAre("command 1 to uav1, sent at 12.2 s, was not acknowledged"));
    EXPECT_EQ(verdict.Summary.back(), "Failed");
    EXPECT_THAT(verdict.Summary, testing::Contains(HasSubstr("FAILED: command 1 to uav1")));
}

TEST(Verdict, FailsForAnAnswerOfTheWrongAircraft)
{
    CommandLog log;
    log.Sent(ToUav1(), 1);
    log.Answered(Ack(1, "uav2"), 2);
    log.Answered(Ack(1, "uav1"), 2);
    EXPECT_THAT(Judge({Good(log)}, log, CommandUav1, 30).Failures,
                ElementsAre("1 acknowledgements came from the wrong aircraft"));
}

TEST(Verdict, FailsForARepeatedAnswer)
{
    CommandLog log = Answered();
    log.Answered(Ack(1, "uav1"), 2);
    EXPECT_THAT(Judge({Good(log)}, log, CommandUav1, 30).Failures,
                ElementsAre("1 acknowledgements came more than once"));
}

TEST(Verdict, FailsForAnAircraftThatWasNeverSentACommand)
{
    CommandLog log;
    log.Refused("uav1");
    AircraftResult result = Good(log);
    EXPECT_THAT(Judge({result}, log, CommandUav1, 30).Failures,
                ElementsAre("uav1: no command was sent to it"));
}

TEST(Verdict, PassesWhenARefusedCommandWasSentLater)
{
    CommandLog log;
    log.Refused("uav1");
    log.Sent(ToUav1(), 1);
    log.Answered(Ack(1, "uav1"), 2);
    EXPECT_TRUE(Judge({Good(log)}, log, CommandUav1, 30).Passed());
}

TEST(Verdict, TellsOfDeclinedAndRefusedCommands)
{
    CommandLog log;
    log.Refused("uav1");
    log.Sent(ToUav1(), 1);
    log.Answered(Ack(1, "uav1", Uav::CommandStage::COMMAND_DECLINED), 2);
    EXPECT_THAT(Judge({Good(log)}, log, CommandUav1, 30).Summary,
                testing::Contains(HasSubstr("1 sent 1 acknowledged, 1 declined, 1 refused for sending")));
}

TEST(Verdict, OnlyReportsAnswersToTheCommandsOfAnotherRun)
{
    CommandLog log = Answered();
    log.Answered(Ack(7, "uav1"), 2);
    const auto verdict = Judge({Good(log)}, log, CommandUav1, 30);
    EXPECT_TRUE(verdict.Passed());
    EXPECT_THAT(verdict.Summary,
                testing::Contains(HasSubstr("1 acknowledgements of commands that this ground")));
}

TEST(Verdict, AsksForNoCommandToAnAircraftThatIsToGetNone)
{
    const CommandLog log;
    EXPECT_TRUE(Judge({Good(log)}, log, {}, 30).Passed());
}

TEST(Verdict, AccountsForACommandThatExpired)
{
    CommandLog log;
    log.Sent(ToUav1(), 1);
    log.OnWay(1, Rabit::QueueOutcome::Expired, 11);
    EXPECT_TRUE(Judge({Good(log)}, log, CommandUav1, 30).Passed());
}

TEST(Verdict, FailsForACommandInDoubt)
{
    CommandLog log;
    log.Sent(ToUav1(), 1);
    log.OnWay(1, Rabit::QueueOutcome::InDoubt, 11);
    EXPECT_FALSE(Judge({Good(log)}, log, CommandUav1, 30).Passed());
}

// A run that must have tracked a target, and the target that it found.
class TargetVerdict : public testing::Test
{
protected:
    CommandLog _log = Answered();
    Ground::FoundTarget _target;

    void SetUp() override
    {
        _target.Aircraft = "uav1";
        _target.Finding.name.aircraft = "uav1";
        _target.Finding.name.number = 3;
        _target.Finding.stage = Uav::TargetStage::TARGET_TRACKED;
        _target.Finding.validated_by = "uav2";
        _target.Finding.tracked_s = 12;
    }
    Ground::Verdict Judged()
    {
        AircraftResult result = Good(_log);
        result.Targets = {_target};
        return Judge({result}, _log, {.Commanded = {"uav1"}, .TrackedTarget = true}, 30);
    }
};

TEST_F(TargetVerdict, PassesWithATargetThatAnotherAircraftValidatedAndThatWasFollowed)
{
    EXPECT_TRUE(Judged().Passed());
    EXPECT_THAT(Judged().Summary, testing::Contains(HasSubstr("uav1/3")));
}

TEST_F(TargetVerdict, FailsWithoutATarget)
{
    EXPECT_THAT(Judge({Good(_log)}, _log, {.TrackedTarget = true}, 30).Failures,
                ElementsAre("no target was found by one aircraft, validated by another, and followed"));
}

TEST_F(TargetVerdict, FailsWhenNobodyValidatedIt)
{
    _target.Finding.validated_by = "";
    EXPECT_FALSE(Judged().Passed());
}

TEST_F(TargetVerdict, FailsWhenItsFinderValidatedItItself)
{
    _target.Finding.validated_by = "uav1";
    EXPECT_FALSE(Judged().Passed());
}

TEST_F(TargetVerdict, FailsWhenItWasNotFollowed)
{
    _target.Finding.stage = Uav::TargetStage::TARGET_VALIDATED;
    EXPECT_FALSE(Judged().Passed());
}

}  // namespace
