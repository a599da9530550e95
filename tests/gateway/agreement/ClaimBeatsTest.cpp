// Renewals of a lease, and their answers, in beats.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ClaimFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

constexpr auto VotersAbstain = 2100ms;

auto IsGain()
{
    return Field(&OwnClaims::Event::What, OwnClaims::Event::Kind::Gained);
}

TEST(ClaimBeats, CostNoDatagramsWhileBeatsRenewTheLease)
{
    ClaimFleet fleet({"ground", "uav1", "uav2", "uav3", "uav4"}, 13);
    fleet.BeatPeriod = 500ms;
    fleet.StartAll();
    fleet.RunFor(VotersAbstain);
    fleet.Want("uav1", "leader");
    fleet.Want("uav2", "cell 1");
    fleet.RunFor(3s);
    fleet.Sent.clear();
    fleet.RunFor(60s);
    EXPECT_THAT(fleet.Sent, IsEmpty());
    EXPECT_THAT(fleet.HoldersOf("leader"), ElementsAre("uav1"));
    EXPECT_THAT(fleet.ToldBy("uav1"), ElementsAre(IsGain()));
    EXPECT_THAT(fleet.ToldBy("uav2"), ElementsAre(IsGain()));
}

TEST(ClaimBeats, TakeNoAnswerInABeatThatIsForAFormerLife)
{
    ClaimFleet fleet({"a", "b"}, 14);
    fleet.StartAll();
    fleet.RunFor(VotersAbstain);
    fleet.Want("a", "leader");
    fleet.RunFor(1s);
    const AgreementNode::Beat former = fleet["a"].TakeBeat(fleet.LocalOf("a"));
    fleet["b"].OnBeat("a", 1, former, fleet.LocalOf("b"));
    const AgreementNode::Beat answer = fleet["b"].TakeBeat(fleet.LocalOf("b"));
    ASSERT_EQ(answer.Answers.size(), AgreementNode::AnswerBytes);
    ClaimFleet::Duration end = fleet.LocalOf("a");
    while (fleet["a"].Own().FenceOf("leader", end))
    {
        end += 1ms;
    }
    fleet["a"].OnBeat("b", 1, answer, fleet.LocalOf("a"));
    EXPECT_TRUE(fleet["a"].Own().FenceOf("leader", end));

    fleet.Kill("a");
    fleet.Start("a");  // wants it at once, in a session with the same number
    const AgreementNode::Beat present = fleet["a"].TakeBeat(fleet.LocalOf("a"));
    EXPECT_EQ(present.Renewal.size(), AgreementNode::RenewalBytes);
    fleet["a"].OnBeat("b", 1, answer, fleet.LocalOf("a"));
    const auto due = fleet["a"].TakeDue(fleet.LocalOf("a"));
    EXPECT_TRUE(!due || due->To.empty()) << "it orders something in a book of its former life";
}

// A fleet may have nodes with one path and nodes with several ones.
TEST(ClaimBeats, AreAnsweredWithADatagramByANodeThatDoesNotRideInBeats)
{
    AgreementNode claimant(
        {.Self = "a", .Incarnation = 1, .Members = {"a", "b"}}, 0, [] { return 1; }, 0s);
    AgreementNode voter(
        {.Self = "b", .Incarnation = 1, .Members = {"a", "b"}, .RidesInBeats = false}, 0, [] { return 2; },
        0s);
    ASSERT_TRUE(claimant.Own().Want("leader", true, VotersAbstain));
    voter.OnBeat("a", 1, claimant.TakeBeat(VotersAbstain), VotersAbstain);
    EXPECT_EQ(voter.AnswersForBeat(), 0U);
    const auto answer = voter.TakeDue(VotersAbstain);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->To, "a");
    EXPECT_TRUE(DecodeClaimReply(answer->Bytes));
}

TEST(ClaimBeats, KeepTheAnswersForWhichABeatHasNoRoom)
{
    ClaimFleet fleet({"a", "b", "c"}, 16);
    fleet.StartAll();
    fleet.RunFor(VotersAbstain);
    const std::vector<std::uint8_t> renewal{1, 0, 0, 0, 1, 0, 0, 0};
    fleet["a"].OnBeat("b", 1, {.Renewal = renewal}, fleet.LocalOf("a"));
    fleet["a"].OnBeat("c", 1, {.Renewal = renewal}, fleet.LocalOf("a"));
    EXPECT_EQ(fleet["a"].AnswersForBeat(), 2U);
    EXPECT_EQ(fleet["a"].TakeBeat(fleet.LocalOf("a"), true, 0).Answers.size(), 0U);
    EXPECT_EQ(fleet["a"].TakeBeat(fleet.LocalOf("a"), true, 1).Answers.size(), AgreementNode::AnswerBytes);
    EXPECT_EQ(fleet["a"].TakeBeat(fleet.LocalOf("a")).Answers.size(), AgreementNode::AnswerBytes);
}

TEST(ClaimBeats, ReadAnyBytesOfABeat)
{
    ClaimFleet fleet({"a", "b"}, 15);
    fleet.StartAll();
    fleet.RunFor(VotersAbstain);
    for (std::size_t size = 0; size < 2 * AgreementNode::AnswerBytes; ++size)
    {
        const std::vector<std::uint8_t> bytes(size, 0xff);
        fleet["a"].OnBeat("b", 1, {.Renewal = bytes, .Answers = bytes}, fleet.LocalOf("a"));
    }
    EXPECT_THAT(fleet.HoldersOf("leader"), IsEmpty());
    EXPECT_EQ(fleet["a"].TakeBeat(fleet.LocalOf("a")).Answers.size(), AgreementNode::AnswerBytes);
}

}  // namespace
}  // namespace Rabit
