#include "CommandLog.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace
{
using Answer = Ground::CommandLog::Answer;
using Ground::CommandLog;
using Ground::CommandProgress;
using Rabit::QueueOutcome;
using testing::ElementsAre;
using Uav::CommandStage;

Ground::CommandStatus To(const std::string &node)
{
    Ground::CommandStatus command;
    command.node = node;
    return command;
}

Uav::CommandAck Ack(std::uint32_t id, const std::string &node,
                    CommandStage stage = CommandStage::COMMAND_ACCEPTED, const std::string &reason = "")
{
    Uav::CommandAck ack;
    ack.id = id;
    ack.node = node;
    ack.stage = stage;
    ack.reason = reason;
    return ack;
}

TEST(CommandLog, NumbersCommandsFromOne)
{
    CommandLog log;
    EXPECT_EQ(log.NextId(), 1u);
    EXPECT_EQ(log.Sent(To("uav1"), 0), 1u);
    EXPECT_EQ(log.Sent(To("uav2"), 0), 2u);
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
    log.Sent(To("uav1"), 1.5);
    log.Sent(To("uav2"), 2.5);
    log.Sent(To("uav1"), 3.5);
    log.Answered(Ack(2, "uav2"), 5);
    const auto outstanding = log.Outstanding();
    ASSERT_EQ(outstanding.size(), 2u);
    EXPECT_EQ(outstanding[0].id, 1u);
    EXPECT_EQ(outstanding[0].node, "uav1");
    EXPECT_EQ(outstanding[0].sent_s, 1.5);
    EXPECT_EQ(outstanding[1].id, 3u);
}

TEST(CommandLog, CountsAnAnswerForItsAircraft)
{
    CommandLog log;
    log.Sent(To("uav1"), 0);
    log.Sent(To("uav1"), 0);
    EXPECT_EQ(log.Answered(Ack(1, "uav1"), 5), Answer::Counted);
    EXPECT_EQ(log.Answered(Ack(2, "uav1", CommandStage::COMMAND_DECLINED), 5), Answer::Counted);
    EXPECT_EQ(log.Of("uav1").Sent, 2u);
    EXPECT_EQ(log.Of("uav1").Acknowledged, 2u);
    EXPECT_EQ(log.Of("uav1").Declined, 1u);
}

TEST(CommandLog, DoesNotTakeTheAnswerOfAnotherAircraft)
{
    CommandLog log;
    log.Sent(To("uav1"), 0);
    EXPECT_EQ(log.Answered(Ack(1, "uav2"), 5), Answer::WrongNode);
    EXPECT_EQ(log.WrongNode(), 1u);
    EXPECT_EQ(log.Of("uav1").Acknowledged, 0u);
    EXPECT_EQ(log.Of("uav2").Acknowledged, 0u);
    EXPECT_EQ(log.Outstanding().size(), 1u);
}

TEST(CommandLog, CountsARepeatedAnswerOnce)
{
    CommandLog log;
    log.Sent(To("uav1"), 0);
    log.Answered(Ack(1, "uav1"), 5);
    EXPECT_EQ(log.Answered(Ack(1, "uav1"), 5), Answer::Repeated);
    EXPECT_EQ(log.Repeated(), 1u);
    EXPECT_EQ(log.Of("uav1").Acknowledged, 1u);
}

TEST(CommandLog, KnowsAnswersToCommandsThatItNeverSent)
{
    CommandLog log;
    log.Sent(To("uav1"), 0);
    EXPECT_EQ(log.Answered(Ack(0, "uav1"), 5), Answer::Unknown);
    EXPECT_EQ(log.Answered(Ack(2, "uav1"), 5), Answer::Unknown);
    EXPECT_EQ(log.Unknown(), 2u);
}

TEST(CommandLog, NumbersCommandsFromTheFirstIdThatItWasGiven)
{
    CommandLog log(4'000'000'001);
    EXPECT_EQ(log.Sent(To("uav1"), 0), 4'000'000'001u);
    EXPECT_EQ(log.Commands()[0].number, 1u);
    EXPECT_EQ(log.Answered(Ack(4'000'000'001, "uav1"), 1), Answer::Counted);
}

TEST(CommandLog, DoesNotTakeAnAnswerToACommandOfAnotherRun)
{
    CommandLog log(20001);
    log.Sent(To("uav1"), 0);
    EXPECT_EQ(log.Answered(Ack(10001, "uav1"), 1), Answer::Unknown);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_SENT);
}

TEST(CommandLog, FollowsACommandToItsEnd)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_SENT);
    log.OnWay(1, QueueOutcome::Pending, 2);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_SENT);
    log.OnWay(1, QueueOutcome::Delivered, 3);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_DELIVERED);
    EXPECT_EQ(log.Commands()[0].changed_s, 3);
    log.Answered(Ack(1, "uav1"), 4);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_ACCEPTED);
    log.Answered(Ack(1, "uav1", CommandStage::COMMAND_DONE), 5);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_DONE);
    EXPECT_EQ(log.Of("uav1").Acknowledged, 1u);
}

TEST(CommandLog, DoesNotGoBackWhenTheReceiptComesAfterTheAnswer)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    log.Answered(Ack(1, "uav1"), 2);
    log.OnWay(1, QueueOutcome::Delivered, 3);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_ACCEPTED);
}

TEST(CommandLog, KeepsTheReasonOfTheLastWord)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    log.Answered(Ack(1, "uav1"), 2);
    log.Answered(Ack(1, "uav1", CommandStage::COMMAND_REPLACED, "battery is low"), 3);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_REPLACED);
    EXPECT_EQ(log.Commands()[0].reason, "battery is low");
}

std::vector<CommandProgress> StepsOf(const CommandLog &log)
{
    std::vector<CommandProgress> steps;
    for (const Ground::CommandStep &step : log.Commands().at(0).steps)
        steps.push_back(step.progress);
    return steps;
}

TEST(CommandLog, KeepsEveryStepWithItsTime)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    log.OnWay(1, QueueOutcome::Delivered, 3);
    log.Answered(Ack(1, "uav1"), 4);
    log.Answered(Ack(1, "uav1", CommandStage::COMMAND_REPLACED, "it goes home"), 5);
    EXPECT_THAT(StepsOf(log),
                ElementsAre(CommandProgress::PROGRESS_SENT, CommandProgress::PROGRESS_DELIVERED,
                            CommandProgress::PROGRESS_ACCEPTED, CommandProgress::PROGRESS_REPLACED));
    EXPECT_EQ(log.Commands()[0].steps[1].at_s, 3);
    EXPECT_EQ(log.Commands()[0].steps[3].reason, "it goes home");
}

TEST(CommandLog, CountsACommandAsDeliveredThatIsAnsweredBeforeItsReceipt)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    log.Answered(Ack(1, "uav1"), 2);
    log.OnWay(1, QueueOutcome::Delivered, 3);
    EXPECT_THAT(StepsOf(log), ElementsAre(CommandProgress::PROGRESS_SENT, CommandProgress::PROGRESS_DELIVERED,
                                          CommandProgress::PROGRESS_ACCEPTED));
}

TEST(CommandLog, NamesTheCommandThatReplacedOneByItsNumber)
{
    CommandLog log(1'232'690'001);
    log.Sent(To("uav1"), 1);
    log.Sent(To("uav1"), 2);
    log.Answered(Ack(1'232'690'001, "uav1"), 3);
    Uav::CommandAck replaced = Ack(1'232'690'001, "uav1", CommandStage::COMMAND_REPLACED);
    replaced.replaced_by = 1'232'690'002;
    log.Answered(replaced, 4);
    EXPECT_EQ(log.Commands()[0].reason, "command 2");
}

TEST(CommandLog, HasNoNumberForACommandOfSomebodyElse)
{
    CommandLog log(20001);
    log.Sent(To("uav1"), 1);
    Uav::CommandAck replaced = Ack(20001, "uav1", CommandStage::COMMAND_REPLACED);
    replaced.replaced_by = 70001;
    log.Answered(replaced, 4);
    EXPECT_EQ(log.Commands()[0].reason, "a command that this ground station did not give");
}

TEST(CommandLog, EndsWhatAnAircraftHadAcceptedBeforeItStartedAnew)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    log.Sent(To("uav2"), 1);
    log.Sent(To("uav1"), 1);
    log.Answered(Ack(1, "uav1"), 2);
    log.Answered(Ack(2, "uav2"), 2);
    log.Answered(Ack(3, "uav1"), 7);  // by its new life
    log.StartedAnew("uav1", 5, 8);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_REPLACED);
    EXPECT_EQ(log.Commands()[0].reason, "the aircraft has started anew");
    EXPECT_EQ(log.Commands()[1].progress, CommandProgress::PROGRESS_ACCEPTED);
    EXPECT_EQ(log.Commands()[2].progress, CommandProgress::PROGRESS_ACCEPTED);
}

TEST(CommandLog, AnExpiredCommandIsAccountedFor)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    log.OnWay(1, QueueOutcome::Expired, 12);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_EXPIRED);
    EXPECT_TRUE(log.Outstanding().empty());
}

TEST(CommandLog, ACommandInDoubtIsOutstandingUntilTheAircraftAnswers)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    log.OnWay(1, QueueOutcome::InDoubt, 2);
    EXPECT_EQ(log.Outstanding().size(), 1u);
    log.Answered(Ack(1, "uav1"), 3);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_ACCEPTED);
    EXPECT_TRUE(log.Outstanding().empty());
}

TEST(CommandLog, TheStateOfTheAircraftEndsTheDoubt)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    log.Sent(To("uav1"), 1);
    log.Sent(To("uav2"), 1);
    for (std::uint32_t id = 1; id <= 3; ++id)
    {
        log.OnWay(id, QueueOutcome::InDoubt, 5);
    }
    log.StartedAnew("uav1", 4, 5);
    log.Reported("uav1", 2, 5, 6);
    EXPECT_EQ(log.Outstanding().size(), 3u) << "it may be a state of the former life";
    log.Reported("uav1", 2, 5.5, 6);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_REPLACED);
    EXPECT_EQ(log.Commands()[0].reason, "the aircraft has started anew");
    EXPECT_EQ(log.Commands()[1].progress, CommandProgress::PROGRESS_ACCEPTED);
    EXPECT_EQ(log.Of("uav1").Acknowledged, 1u);
    EXPECT_EQ(log.Commands()[2].progress, CommandProgress::PROGRESS_IN_DOUBT) << "of another aircraft";
    log.Answered(Ack(2, "uav1", CommandStage::COMMAND_DONE), 7);
    EXPECT_EQ(log.Commands()[1].progress, CommandProgress::PROGRESS_DONE);
    EXPECT_EQ(log.Of("uav1").Acknowledged, 1u);
}

// As one that expired while the aircraft was silent.
TEST(CommandLog, TheStateOfAnAircraftThatHasNotRestartedLeavesTheAnswerToIt)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    log.OnWay(1, QueueOutcome::InDoubt, 12);
    log.Reported("uav1", 0, 20, 20.5);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_IN_DOUBT);
    log.Answered(Ack(1, "uav1", CommandStage::COMMAND_DECLINED, "too low"), 21);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_DECLINED);
    EXPECT_EQ(log.Commands()[0].reason, "too low");
}

TEST(CommandLog, TheStateOfTheAircraftChangesNoCommandThatIsNotInDoubt)
{
    CommandLog log;
    log.Sent(To("uav1"), 1);
    log.Reported("uav1", 0, 5, 6);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_SENT);
}

TEST(CommandLog, ShowsACommandThatWasNeverSent)
{
    CommandLog log;
    log.RefusedForGood(To("uav9"), "it is not known", 2);
    EXPECT_EQ(log.Commands()[0].progress, CommandProgress::PROGRESS_REFUSED);
    EXPECT_EQ(log.Commands()[0].reason, "it is not known");
    EXPECT_EQ(log.NextId(), 2u);
    EXPECT_EQ(log.Of("uav9").Sent, 0u);
    EXPECT_TRUE(log.Outstanding().empty());
}

}  // namespace
