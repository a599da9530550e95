// Sessions, proofs that they are live, and epochs, as an opener applies them.
#include <gtest/gtest.h>

#include "SealNodes.h"

namespace
{

using namespace SealNodes;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

class SealFreshness : public testing::Test
{
protected:
    Authority Signs;
    Node A{Signs, "uav1", 1};
    Node B{Signs, "uav2", 2};
};

TEST_F(SealFreshness, BulletinsOfAStrangerAreHeardOnceItHasClaimed)
{
    EXPECT_EQ(B.Fault(A.ToAll(A.Message(), OuterClass::Meeting)), OpenFault::UnknownSession);
    const Opener::Result claimed = B.Opens.Open(A.Claims(), Start);
    EXPECT_EQ(claimed.Verdict, ClaimVerdict::Added);
    EXPECT_EQ(claimed.Challenge, A.NonceOf());
    EXPECT_TRUE(claimed.Message.empty());
    EXPECT_EQ(B.Fault(A.ToAll(A.Message(), OuterClass::Meeting)), OpenFault::NotFresh);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message(), OuterClass::Bulletin)), OpenFault::None);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message())), OpenFault::NotFresh);
}

TEST_F(SealFreshness, TrafficIsTakenOnceTheSenderHasAnsweredANonce)
{
    B.Fault(A.Claims());
    const Bytes early = A.ToAll(A.Message());
    EXPECT_EQ(B.Opens.Open(A.Claims({{9, 9, 9}}), Start).Verdict, ClaimVerdict::Known);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message())), OpenFault::NotFresh);
    EXPECT_EQ(B.Opens.Open(A.Claims({{9, 9, 9}, B.NonceOf()}, false), Start).Verdict, ClaimVerdict::Proven);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message())), OpenFault::None);
    // A datagram from before the proof may be a recording.
    EXPECT_EQ(B.Fault(early), OpenFault::TooOld);
}

TEST_F(SealFreshness, AfterTenSecondsOfSilenceProofIsDueAgain)
{
    B.Meet(A);
    A.Meet(B);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message()), Start + seconds(9)), OpenFault::None);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message()), Start + seconds(19)), OpenFault::None);
    const TimePoint late = Start + seconds(19) + milliseconds(10'001);
    const Bytes recorded = A.Pairwise(A.Message(), B);
    const Bytes recordedGroup = A.ToAll(A.Message());
    const Bytes recordedCard = A.ToAll(A.Message(), OuterClass::Meeting);
    EXPECT_EQ(B.Fault(recorded, late), OpenFault::NotFresh);
    EXPECT_EQ(B.Fault(recordedCard, late), OpenFault::NotFresh);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message()), late), OpenFault::NotFresh);
    B.Ask(late);
    B.Meet(A, late);
    // Recordings from the silence stay out, in both modes.
    EXPECT_EQ(B.Fault(recorded, late), OpenFault::TooOld);
    EXPECT_EQ(B.Fault(recordedGroup, late), OpenFault::TooOld);
    EXPECT_EQ(B.Fault(recordedCard, late), OpenFault::TooOld);
    EXPECT_EQ(B.Fault(A.Pairwise(A.Message(), B), late), OpenFault::None);
}

TEST_F(SealFreshness, ARecordedAnswerIsWorthNothingAfterTenSeconds)
{
    const Bytes answer = A.Claims({B.NonceOf()});
    EXPECT_EQ(B.Opens.Open(answer, Start + milliseconds(10'001)).Verdict, ClaimVerdict::Added);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message()), Start + milliseconds(10'001)), OpenFault::NotFresh);
}

TEST_F(SealFreshness, AnAnswerCountsFromWhenItsNonceWasMade)
{
    B.Opens.Open(A.Claims({B.NonceOf()}), Start + seconds(9));
    EXPECT_EQ(B.Fault(A.ToAll(A.Message()), Start + milliseconds(10'001)), OpenFault::NotFresh);
}

TEST_F(SealFreshness, TheFormerNonceCountsToo)
{
    const Nonce former = B.NonceOf();
    B.Ask(Start + seconds(3));
    EXPECT_EQ(B.Opens.Open(A.Claims({former}), Start + seconds(4)).Verdict, ClaimVerdict::Proven);
    B.Ask(Start + seconds(5));
    EXPECT_EQ(B.Opens.Open(A.Claims({former}), Start + seconds(5)).Verdict, ClaimVerdict::Known);
}

TEST_F(SealFreshness, NoAnswerIsAnAnswerToNoNonce)
{
    const OwnChallenges none;
    const Nonce zero{};
    EXPECT_FALSE(none.AnsweredBy({&zero, 1}, TimePoint{}).has_value());
}

TEST_F(SealFreshness, YesterdaysSessionIsNotHeard)
{
    const Bytes claim = A.Claims({B.NonceOf()});
    const Bytes traffic = A.ToAll(A.Message());
    B.Fault(claim);
    ASSERT_EQ(B.Fault(traffic), OpenFault::None);
    // B restarts. The opponent replays all of yesterday.
    Node again(Signs, "uav2", 2, 1);
    EXPECT_EQ(again.Fault(traffic), OpenFault::UnknownSession);
    EXPECT_EQ(again.Opens.Open(claim, Start).Verdict, ClaimVerdict::Added);
    EXPECT_EQ(again.Fault(traffic), OpenFault::NotFresh);
    EXPECT_EQ(again.Fault(claim), OpenFault::Replayed);
}

TEST_F(SealFreshness, ARecordedClaimOfADisplacedSessionAsksForNoAnswer)
{
    const Bytes recorded = A.Claims();
    EXPECT_EQ(B.Fault(recorded), OpenFault::None);
    for (std::uint8_t opening = 1; opening <= SessionTable::MostUnprovenOfOne; ++opening)
    {
        Node next(Signs, "uav1", 1, opening);
        B.Fault(next.Claims(), Start + seconds(opening));
    }
    ASSERT_EQ(B.Sessions.Find(TagOf(A.Me.Own)), nullptr);
    const Opener::Result again = B.Opens.Open(recorded, Start + seconds(9));
    EXPECT_EQ(again.Fault, OpenFault::TooOld);
    EXPECT_EQ(again.Challenge, Nonce{});
    // The node itself has higher numbers.
    EXPECT_EQ(B.Fault(A.Claims(), Start + seconds(9)), OpenFault::None);
}

TEST_F(SealFreshness, AClaimThatOnlyNamesItsCertificateAsksForIt)
{
    const Opener::Result result = B.Opens.Open(A.Claims({}, false), Start);
    EXPECT_EQ(result.Fault, OpenFault::UnknownCertificate);
    EXPECT_EQ(result.Wanted, A.Me.Own.Certificate);
    // Another session of the same certificate knows it.
    B.Fault(A.Claims());
    Node second(Signs, "uav1", 1, 1);
    EXPECT_EQ(B.Opens.Open(second.Claims({}, false), Start).Verdict, ClaimVerdict::Added);
}

TEST_F(SealFreshness, AClaimOfAStrangersAuthorityIsRefused)
{
    Authority other;
    other.Signing = *SigningKey::Of(SeedOf(9, 9));
    Node stranger(other, "uav7", 7);
    EXPECT_EQ(B.Fault(stranger.Claims({B.NonceOf()})), OpenFault::BadCertificate);
    EXPECT_EQ(B.Sessions.Size(), 0u);
    EXPECT_EQ(B.Sessions.CertificateOf(stranger.Me.Own.Certificate), nullptr);
}

TEST_F(SealFreshness, AClaimWithTheCertificateOfAnotherHashIsRefused)
{
    A.Me.Own.Certificate[0] ^= 1;
    Sealer seals(A.Me, A.Epochs);
    const Bytes claim =
        Node::Taken([&](auto out) { return seals.SealClaim({}, std::vector{B.NonceOf()}, true, out); });
    EXPECT_EQ(B.Fault(claim), OpenFault::BadClaim);
    EXPECT_EQ(B.Sessions.Size(), 0u);
}

TEST_F(SealFreshness, AClaimThatAnotherMemberSignedIsRefused)
{
    // C has the certificate of A, which is public, and the epoch's secret.
    A.Me.Signing = *SigningKey::Of(SeedOf(3, 3));
    EXPECT_EQ(B.Fault(A.Claims({B.NonceOf()})), OpenFault::BadSignature);
    EXPECT_EQ(B.Sessions.Size(), 0u);
}

TEST_F(SealFreshness, AClaimWithoutTheEpochsSecretIsRefusedWithoutASignature)
{
    Node stranger(Signs, "uav7", 7);
    stranger.Epochs = EpochSecrets();
    stranger.Epochs.Learn(1, SecondSecret, {}, Start);
    EXPECT_EQ(B.Fault(stranger.Claims()), OpenFault::NotAuthentic);
}

TEST_F(SealFreshness, AClaimWithAnyBitFlippedIsRefused)
{
    const Bytes claim = A.Claims({B.NonceOf()});
    for (std::size_t bit = 0; bit < 8 * claim.size(); ++bit)
    {
        Bytes flipped = claim;
        flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1 << bit % 8);
        // Claims of unknown sessions have a budget: 2000 in a second.
        ASSERT_NE(B.Fault(flipped, Start + milliseconds(bit)), OpenFault::None) << "bit " << bit;
    }
    EXPECT_EQ(B.Opens.Count(OpenFault::OverBudget), 0u);
    EXPECT_EQ(B.Sessions.Size(), 0u);
    EXPECT_EQ(B.Opens.Open(claim, Start + seconds(9)).Verdict, ClaimVerdict::Proven);
}

TEST_F(SealFreshness, AMemberDoesNotGetAnothersSession)
{
    B.Meet(A);
    // C takes A's session, and RTPS headers of its own.
    Node same(Signs, "uav3", 3, 0, 0, {HeaderOf(3)});
    same.Me.Own.Session = A.Me.Own.Session;
    Sealer seals(same.Me, same.Epochs);
    const Bytes claim =
        Node::Taken([&](auto out) { return seals.SealClaim({}, std::vector{B.NonceOf()}, true, out); });
    EXPECT_EQ(B.Opens.Open(claim, Start).Verdict, ClaimVerdict::Proven);
    // It is another session: the tag and all keys depend on the certificate.
    EXPECT_NE(TagOf(same.Me.Own), TagOf(A.Me.Own));
    EXPECT_EQ(B.Fault(A.ToAll(A.Message())), OpenFault::None);
}

TEST_F(SealFreshness, TheFirstProvenClaimOfAPrefixHolds)
{
    B.Meet(A);
    Node thief(Signs, "uav3", 3, 0, 0, {HeaderOf(3), HeaderOf(1)});
    const Opener::Result refused = B.Opens.Open(thief.Claims({B.NonceOf()}), Start);
    EXPECT_EQ(refused.Fault, OpenFault::RefusedClaim);
    EXPECT_EQ(refused.Verdict, ClaimVerdict::PrefixTaken);
    EXPECT_EQ(refused.Claimant, "uav3");
    EXPECT_EQ(refused.Holder, "uav1");
    EXPECT_EQ(B.Fault(thief.ToAll(thief.Message())), OpenFault::UnknownSession);
}

TEST_F(SealFreshness, ARevokedNodeIsNotHeardInAnyEpoch)
{
    Node c(Signs, "uav3", 3);
    B.Meet(A);
    B.Meet(c);
    const Bytes before = A.ToAll(A.Message());
    B.Epochs.Learn(2, SecondSecret, {1}, Start);
    EXPECT_EQ(B.Fault(before), OpenFault::Revoked);
    EXPECT_EQ(B.Fault(c.ToAll(c.Message())), OpenFault::None);
    B.Sessions.EndRevoked(B.Epochs);
    EXPECT_EQ(B.Sessions.Size(), 1u);
    EXPECT_EQ(B.Fault(A.Claims({B.NonceOf()})), OpenFault::Revoked);
    EXPECT_EQ(B.Sessions.Size(), 1u);
}

TEST_F(SealFreshness, AFormerEpochIsTakenForTenMinutesAndThenItsBulletinsAlone)
{
    B.Meet(A);
    A.Meet(B);
    B.Epochs.Learn(2, SecondSecret, {}, Start);
    for (int i = 1; i <= 75; ++i)
    {
        ASSERT_EQ(B.Fault(A.ToAll(A.Message()), Start + seconds(8 * i)), OpenFault::None);
    }
    const TimePoint late = Start + minutes(10) + milliseconds(1);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message()), late), OpenFault::OldEpoch);
    EXPECT_EQ(B.Fault(A.Pairwise(A.Message(), B), late), OpenFault::OldEpoch);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message(), OuterClass::Meeting), late), OpenFault::OldEpoch);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message(), OuterClass::Bulletin), late), OpenFault::None);
    // B answers in A's epoch, in bulletins alone.
    Bytes out(1000);
    EXPECT_EQ(B.Seals.SealGroup(B.Message(), OuterClass::Traffic, out, Epoch{1}).Fault, SealFault::NoEpoch);
    const Bytes answer = Node::Taken(
        [&](auto to) { return B.Seals.SealGroup(B.Message(), OuterClass::Bulletin, to, Epoch{1}); });
    EXPECT_EQ(A.Fault(answer, late), OpenFault::None);
    // Both in the new epoch hear each other again.
    A.Epochs.Learn(2, SecondSecret, {}, late);
    EXPECT_EQ(B.Fault(A.ToAll(A.Message()), late), OpenFault::None);
    EXPECT_EQ(B.Fault(A.Pairwise(A.Message(), B), late), OpenFault::None);
}

TEST_F(SealFreshness, PairwiseInAFormerEpochGoBulletinsAlone)
{
    B.Meet(A);
    A.Meet(B);
    const Receiver former = A.ReceiverOf(B);
    A.Epochs.Learn(2, SecondSecret, {}, Start);
    Bytes out(1000);
    EXPECT_EQ(A.Seals.SealPairwise(A.Message(), OuterClass::Traffic, former, out).Fault, SealFault::NoEpoch);
    const Bytes bulletin = Node::Taken(
        [&](auto to) { return A.Seals.SealPairwise(A.Message(), OuterClass::Bulletin, former, to); });
    EXPECT_EQ(B.Fault(bulletin), OpenFault::None);
}

TEST_F(SealFreshness, NothingIsSealedWithoutAnEpoch)
{
    Node c(Signs, "uav3", 3);
    c.Meet(A);
    const Receiver toA = c.ReceiverOf(A);
    c.Epochs = EpochSecrets();
    Bytes out(1000);
    EXPECT_EQ(c.Seals.SealGroup(c.Message(), OuterClass::Traffic, out).Fault, SealFault::NoEpoch);
    EXPECT_EQ(c.Seals.SealPairwise(c.Message(), OuterClass::Traffic, toA, out).Fault, SealFault::NoEpoch);
    EXPECT_EQ(c.Seals.SealClaim({}, {}, true, out).Fault, SealFault::NoEpoch);
}

}  // namespace
