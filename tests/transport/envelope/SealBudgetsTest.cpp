// Processor time that others may cause.
#include <gtest/gtest.h>

#include "SealNodes.h"

namespace
{

using namespace SealNodes;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

// Signatures that a share of 10 ms pays for.
constexpr std::uint64_t PaidSignatures = 10'000 / 110;

class SealBudgets : public testing::Test, protected Three
{
protected:
    // B gets this a thousand times at once.
    void Flood(const Bytes &datagram)
    {
        for (int i = 0; i < 1000; ++i)
        {
            B.Fault(datagram);
        }
    }
    std::uint64_t CountAtB(OpenFault fault) const { return B.Opens.Count(fault); }
};

TEST_F(SealBudgets, BadSignaturesInAnothersNameAreBounded)
{
    Flood(ForgedGroup(C, A, 500));
    EXPECT_EQ(CountAtB(OpenFault::BadSignature), PaidSignatures);
    EXPECT_EQ(CountAtB(OpenFault::OverBudget), 1000 - PaidSignatures);
}

TEST_F(SealBudgets, ClaimsWithBadSignaturesInAnothersNameAreBounded)
{
    // The certificate is A's, the key that signs is C's.
    A.Me.Signing = SigningKey::Of(SeedOf(3, 3)).value();
    Flood(A.Claims());
    EXPECT_EQ(CountAtB(OpenFault::BadSignature), PaidSignatures);
}

TEST_F(SealBudgets, AFloodOfBadSignaturesKeepsBackNoOtherSessionAndNothingPairwise)
{
    Flood(ForgedGroup(C, A, 500));
    EXPECT_EQ(B.Fault(C.ToAll(C.Message())), OpenFault::None);
    EXPECT_EQ(B.Fault(A.Pairwise(A.Message(), B)), OpenFault::None);
}

TEST_F(SealBudgets, AfterAFloodOfBadSignaturesTheSessionIsHeardAgain)
{
    Flood(ForgedGroup(C, A, 500));
    const Bytes good = A.ToAll(A.Message());
    EXPECT_EQ(B.Fault(good), OpenFault::OverBudget);
    // One signature has been earned. Good ones spend nothing.
    const TimePoint after = Start + milliseconds(11);
    EXPECT_EQ(B.Fault(good, after), OpenFault::None);
    for (int i = 0; i < 100; ++i)
    {
        ASSERT_EQ(B.Fault(A.ToAll(A.Message()), after), OpenFault::None);
    }
}

TEST_F(SealBudgets, ARevokedMemberKeepsBackNothingOfTheNewestEpoch)
{
    A.Epochs.Learn(2, SecondSecret, {3}, Start);
    B.Epochs.Learn(2, SecondSecret, {3}, Start);
    Flood(ForgedGroup(C, A, 500));
    ASSERT_EQ(CountAtB(OpenFault::BadSignature), PaidSignatures);
    // A is a suspect in the newest epoch, too, by one datagram of another member.
    ASSERT_EQ(B.Fault(ForgedGroup(C, A, 501, 2, SecondSecret)), OpenFault::BadSignature);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message())), OpenFault::None);
}

TEST_F(SealBudgets, StrangersShareTenMillisecondsOfSignatures)
{
    Node stranger(Signs, "uav7", 7);
    B.Fault(stranger.Claims());
    std::uint64_t verified = 0;
    for (int i = 0; i < 1000; ++i)
    {
        const Bytes bulletin = stranger.ToAll(stranger.Message(), OuterClass::Bulletin);
        verified += B.Fault(bulletin) == OpenFault::None ? 1 : 0;
    }
    // The claim took two of them.
    EXPECT_EQ(verified, PaidSignatures - 2);
    EXPECT_EQ(CountAtB(OpenFault::OverBudget), 1000 - verified);
    // An answer has a budget of its own. A session that has answered needs none.
    EXPECT_EQ(B.Opens.Open(stranger.Claims({B.NonceOf()}), Start).Verdict, ClaimVerdict::Proven);
    for (int i = 0; i < 1000; ++i)
    {
        ASSERT_EQ(B.Fault(stranger.ToAll(stranger.Message())), OpenFault::None);
    }
    // A second later there is as much again.
    Node late(Signs, "uav8", 8);
    EXPECT_EQ(B.Fault(late.Claims()), OpenFault::OverBudget);
    EXPECT_EQ(B.Fault(late.Claims(), Start + seconds(1)), OpenFault::None);
}

TEST_F(SealBudgets, AClaimOverBudgetAsksForAnAnswer)
{
    Node stranger(Signs, "uav7", 7);
    B.Fault(stranger.Claims());
    for (std::uint64_t i = 0; i < PaidSignatures; ++i)
    {
        B.Fault(stranger.ToAll(stranger.Message(), OuterClass::Bulletin));
    }
    Node late(Signs, "uav8", 8);
    const Opener::Result result = B.Opens.Open(late.Claims(), Start);
    EXPECT_EQ(result.Fault, OpenFault::OverBudget);
    EXPECT_EQ(result.Challenge, late.NonceOf());
    EXPECT_EQ(result.Sender, nullptr);
}

TEST_F(SealBudgets, UnknownSessionsShareTheTimeForTheirKeys)
{
    // Anybody can send this: it takes no secret.
    Node outsider(Signs, "uav7", 7);
    outsider.Epochs = EpochSecrets();
    outsider.Epochs.Learn(1, SecondSecret, {}, Start);
    const Bytes claim = outsider.Claims();
    const TimePoint then = Start + seconds(1);
    for (int i = 0; i < 3000; ++i)
    {
        B.Fault(claim, then);
    }
    EXPECT_EQ(CountAtB(OpenFault::NotAuthentic), 20'000u / 10);
    EXPECT_EQ(CountAtB(OpenFault::OverBudget), 1000u);
    // The key of a known session was derived before.
    EXPECT_EQ(B.Fault(A.Claims(), then), OpenFault::None);
    Node late(Signs, "uav8", 8);
    EXPECT_EQ(B.Fault(late.Claims(), then), OpenFault::OverBudget);
    EXPECT_EQ(B.Fault(late.Claims(), then + seconds(1)), OpenFault::None);
}

// Reactions that a share of 10 ms pays for.
constexpr std::uint64_t PaidReactions = 10'000 / 10;

TEST_F(SealBudgets, DatagramsOfInventedSessionsAreLookedUpAndMostlyNoMore)
{
    const TimePoint then = Start + seconds(1);
    Bytes datagram = A.ToAll(A.Message());
    for (std::uint32_t i = 0; i < 10'000; ++i)
    {
        WriteOuter({.Epoch = 1, .Tag = 7 * i + 1, .Number = i}, datagram);
        B.Fault(datagram, then);
    }
    EXPECT_EQ(CountAtB(OpenFault::UnknownSession), PaidReactions);
    EXPECT_EQ(CountAtB(OpenFault::OverBudget), 10'000 - PaidReactions);
    // Sessions that have met are not touched. Nor are the questions to those that were silent.
    EXPECT_EQ(B.Fault(A.ToAll(A.Message()), then), OpenFault::None);
    WriteOuter({.Epoch = 9, .Tag = 5, .Number = 1}, datagram);
    EXPECT_EQ(B.Fault(datagram, then), OpenFault::OverBudget);
    const TimePoint late = then + seconds(11);
    EXPECT_EQ(B.Fault(C.ToAll(C.Message()), late), OpenFault::NotFresh);
}

TEST_F(SealBudgets, DatagramsInTheNamesOfSilentSessionsAreMostlyNoReasonToAsk)
{
    const TimePoint late = Start + seconds(11);
    const Bytes datagram = A.ToAll(A.Message());
    for (int i = 0; i < 3000; ++i)
    {
        B.Fault(datagram, late);
    }
    EXPECT_EQ(CountAtB(OpenFault::NotFresh), PaidReactions);
    EXPECT_EQ(CountAtB(OpenFault::OverBudget), 3000 - PaidReactions);
}

TEST_F(SealBudgets, InventedClaimsAreNotHashedBeyondTheirTime)
{
    // The tag does not belong to the session that is introduced.
    Node outsider(Signs, "uav7", 7);
    Bytes claim = outsider.Claims();
    claim[OuterSize] = static_cast<std::uint8_t>(claim[OuterSize] + 1);
    const TimePoint then = Start + seconds(1);
    for (int i = 0; i < 3000; ++i)
    {
        B.Fault(claim, then);
    }
    EXPECT_EQ(CountAtB(OpenFault::Malformed), 20'000u / 10);
    EXPECT_EQ(CountAtB(OpenFault::OverBudget), 1000u);
}

TEST(EnvelopeProcessorBudget, GrowsWithTimeUpToASecondsShare)
{
    ProcessorBudget budget{milliseconds(1), ProcessorBudget::Signature};
    const auto most = [&budget](TimePoint now)
    {
        int taken = 0;
        while (budget.Take(now))
        {
            ++taken;
        }
        return taken;
    };
    EXPECT_EQ(most(Start), 9);                      // of 1000 us, 110 each
    EXPECT_EQ(most(Start + milliseconds(500)), 4);  // 10 were left, 500 came
    EXPECT_EQ(most(Start + milliseconds(400)), 0);  // time goes back
    EXPECT_EQ(most(Start + minutes(60)), 9);
    // Time in small steps earns no less.
    TimePoint now = Start + minutes(60);
    int taken = 0;
    for (int i = 0; i < 1'000'000; ++i)
    {
        now += std::chrono::microseconds(1);
        taken += budget.Take(now) ? 1 : 0;
    }
    EXPECT_EQ(taken, 9);
}

}  // namespace
