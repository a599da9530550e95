// When a participant that was not authenticated is forgotten, so that both sides begin anew.
#include "guard/AuthenticationRetries.h"

#include <gtest/gtest.h>

#include "guard/RtpsBytes.h"

namespace
{

using namespace std::chrono_literals;
using Rabit::KeyExchange;
using Rabit::Rtps::AuthenticationRetries;
using RtpsBytes::GuidPrefix;
using RtpsBytes::Other;
using RtpsBytes::Sender;
using Step = KeyExchange::Step;

class AuthenticationRetriesTest : public testing::Test
{
protected:
    static constexpr auto Stalled = AuthenticationRetries::Stalled;
    static constexpr auto NotBegun = AuthenticationRetries::NotBegun * Stalled;

    bool Announce(std::uint64_t digest = 1, const GuidPrefix &peer = Sender)
    {
        return Retries.Announced(peer, {.Digest = digest, .Signed = {{10}, {20}}, .Number = 7}, Now);
    }
    // Announces the participant each second for that long.
    void AnnounceFor(std::chrono::seconds time)
    {
        for (const auto end = Now + time; Now < end; Now += 1s)
        {
            Announce();
        }
    }
    bool IsDoubtful() const { return Retries.Doubtful(Now, AnswerTime) == std::vector{Sender}; }
    // How long the participant, which announces itself, is left alone from now on.
    std::chrono::seconds LeftAlone()
    {
        const auto begin = Now;
        while (!IsDoubtful() && Now - begin < 1h)
        {
            Now += 1s;
            Announce();
        }
        return std::chrono::duration_cast<std::chrono::seconds>(Now - begin);
    }
    // As the vendor tells when it is asked.
    void Authenticate()
    {
        Announce();
        AnnounceFor(NotBegun + 1s);
        ASSERT_TRUE(IsDoubtful());
        Retries.IsAuthenticated(Sender);
    }
    void BeginAnew()
    {
        Retries.Forget(Sender);
        Announce();
        Retries.Exchanged(Sender, Step::Request, true, Now);
    }

    AuthenticationRetries Retries;
    AuthenticationRetries::TimePoint Now{1h};
    std::chrono::seconds AnswerTime{0};
};

TEST_F(AuthenticationRetriesTest, AParticipantWhoseHandshakeStallsIsForgotten)
{
    EXPECT_TRUE(Announce());
    Retries.Exchanged(Sender, Step::Request, true, Now);
    EXPECT_EQ(LeftAlone(), Stalled);
    EXPECT_FALSE(Retries.WasForgotten(Sender));
    Retries.Forget(Sender);
    EXPECT_TRUE(Retries.WasForgotten(Sender));
    EXPECT_FALSE(Retries.Due(AnswerTime));
    EXPECT_TRUE(Announce());
    EXPECT_FALSE(Retries.WasForgotten(Sender));
}

TEST_F(AuthenticationRetriesTest, AHandshakeThatHasNotBegunGetsMoreTime)
{
    Announce();
    EXPECT_EQ(LeftAlone(), NotBegun);
}

TEST_F(AuthenticationRetriesTest, AnAuthenticatedParticipantIsNotForgottenForWhatOnlyContradictsIt)
{
    Authenticate();
    EXPECT_FALSE(Announce(2));
    EXPECT_FALSE(Retries.Signs(Sender, {{30}}));
    for (const Step step : {Step::Reply, Step::Final, Step::Keys, Step::Control, Step::Rest})
    {
        Retries.Exchanged(Sender, step, false, Now);
    }
    Retries.Exchanged(Sender, Step::Request, true, Now);
    AnnounceFor(1h);
    EXPECT_FALSE(Retries.Due(AnswerTime));
    EXPECT_TRUE(Retries.TakeToAsk().empty());
}

TEST_F(AuthenticationRetriesTest, ASilentParticipantIsTheVendorsToForgetUnlessTheVendorDoesNot)
{
    AuthenticationRetries keeping{true};
    for (AuthenticationRetries *retries : {&Retries, &keeping})
    {
        retries->Announced(Sender, {.Digest = 1, .Number = 7}, Now);
        retries->Exchanged(Sender, Step::Request, true, Now);
    }
    EXPECT_TRUE(keeping.Doubtful(Now + Stalled - 1s, AnswerTime).empty());
    EXPECT_EQ(keeping.Doubtful(Now + Stalled, AnswerTime), std::vector{Sender});
    EXPECT_TRUE(Retries.Doubtful(Now + 1h, AnswerTime).empty());
    EXPECT_EQ(keeping.Forget(Sender), 8);
    EXPECT_FALSE(keeping.Due(AnswerTime));
}

TEST_F(AuthenticationRetriesTest, AnAuthenticatedParticipantThatBeginsAnewIsAskedAtOnce)
{
    Authenticate();
    Retries.Exchanged(Sender, Step::Request, false, Now);
    EXPECT_EQ(Retries.Due(AnswerTime), Now);
    EXPECT_EQ(Retries.TakeToAsk(), std::vector{Sender});
    EXPECT_TRUE(Retries.TakeToAsk().empty());
}

TEST_F(AuthenticationRetriesTest, ARequestForAHandshakeAndAGoodbyeAreBeginningsToo)
{
    Authenticate();
    Retries.Exchanged(Sender, Step::Ask, false, Now);
    EXPECT_EQ(Retries.TakeToAsk(), std::vector{Sender});
    Retries.IsAuthenticated(Sender);
    Retries.SaidGoodbye(Sender, Now);
    EXPECT_EQ(Retries.TakeToAsk(), std::vector{Sender});
}

TEST_F(AuthenticationRetriesTest, AnAuthenticatedParticipantThatDoesNotAnswerIsForgotten)
{
    Authenticate();
    Retries.Exchanged(Sender, Step::Request, false, Now);
    EXPECT_EQ(LeftAlone(), Stalled);
}

TEST_F(AuthenticationRetriesTest, ForgedBeginningsDoNotAskAnAuthenticatedParticipantMoreOften)
{
    Authenticate();
    int asked = 0;
    for (const auto end = Now + 10 * Stalled; Now < end; Now += 1s)
    {
        Announce();
        Retries.Exchanged(Sender, Step::Request, false, Now);
        Retries.SaidGoodbye(Sender, Now);
        asked += Retries.TakeToAsk().empty() ? 0 : 1;
        if (IsDoubtful())
        {
            Retries.IsAuthenticated(Sender);  // it has answered
        }
    }
    EXPECT_LE(asked, 10);
}

TEST_F(AuthenticationRetriesTest, ForgedStepsAndKeysGiveAParticipantThatDoesNotAnswerNoMoreTime)
{
    Announce();
    Retries.Exchanged(Sender, Step::Request, false, Now);
    Retries.Exchanged(Sender, Step::Final, false, Now);
    Retries.Exchanged(Sender, Step::Keys, false, Now);
    LeftAlone();
    Retries.IsAuthenticated(Sender);
    Retries.Exchanged(Sender, Step::Request, false, Now);
    const auto begin = Now;
    while (!IsDoubtful() && Now - begin < 1h)
    {
        Now += 1s;
        Announce();
        Retries.Exchanged(Sender, Step::Request, false, Now);
        Retries.Exchanged(Sender, Step::Final, false, Now);
        Retries.Exchanged(Sender, Step::Keys, false, Now);
    }
    EXPECT_EQ(Now - begin, Stalled);
}

TEST_F(AuthenticationRetriesTest, AParticipantThatIsNotAuthenticatedIsNotAsked)
{
    Announce();
    Retries.Exchanged(Sender, Step::Request, false, Now);
    Retries.SaidGoodbye(Sender, Now);
    Retries.SaidGoodbye(Other, Now);
    EXPECT_TRUE(Retries.TakeToAsk().empty());
}

TEST_F(AuthenticationRetriesTest, AParticipantThatIsGoneIsNotAsked)
{
    Authenticate();
    Retries.SaidGoodbye(Sender, Now);
    Retries.Gone(Sender);
    EXPECT_TRUE(Retries.TakeToAsk().empty());
    EXPECT_FALSE(Retries.Due(AnswerTime));
}

TEST_F(AuthenticationRetriesTest, AParticipantThatTheVendorHasLostBeginsAnew)
{
    Announce();
    Retries.IsAuthenticated(Sender);
    Retries.Gone(Sender);
    EXPECT_TRUE(Announce());
    EXPECT_EQ(LeftAlone(), NotBegun);
}

TEST_F(AuthenticationRetriesTest, EachStepOfTheHandshakeGivesItMoreTime)
{
    Announce();
    Retries.Exchanged(Sender, Step::Request, false, Now);
    AnnounceFor(Stalled - 1s);
    Retries.Exchanged(Sender, Step::Reply, true, Now);
    EXPECT_EQ(LeftAlone(), Stalled);
}

TEST_F(AuthenticationRetriesTest, RepetitionsAndControlGiveItNoMoreTime)
{
    Announce();
    Retries.Exchanged(Sender, Step::Request, false, Now);
    AnnounceFor(Stalled - 1s);
    Retries.Exchanged(Sender, Step::Request, false, Now);
    Retries.Exchanged(Sender, Step::Control, false, Now);
    Retries.Exchanged(Sender, Step::Rest, false, Now);
    EXPECT_EQ(LeftAlone(), 1s);
}

TEST_F(AuthenticationRetriesTest, DatagramsOfKeysGiveItMoreTimeUpToABound)
{
    Announce();
    for (int i = 0; i <= AuthenticationRetries::MostKeys; ++i)
    {
        EXPECT_FALSE(IsDoubtful());
        AnnounceFor(Stalled - 1s);
        Retries.Exchanged(Sender, Step::Keys, true, Now);
    }
    EXPECT_EQ(LeftAlone(), 1s);
}

TEST_F(AuthenticationRetriesTest, SlowAnswersGiveItMoreTime)
{
    AnswerTime = 3s;
    Announce();
    Retries.Exchanged(Sender, Step::Request, true, Now);
    EXPECT_EQ(LeftAlone(), 48s);
}

TEST_F(AuthenticationRetriesTest, AMessageThatWaitsToBeSentGivesItMoreTime)
{
    Announce();
    Retries.Exchanged(Sender, Step::Request, true, Now);
    LeftAlone();
    Retries.IsWaiting(Sender, Now);
    EXPECT_EQ(LeftAlone(), Stalled);
}

TEST_F(AuthenticationRetriesTest, EachAttemptIsTwiceAsLongUpToABound)
{
    Announce();
    Retries.Exchanged(Sender, Step::Request, true, Now);
    for (const auto expected : {30s, 60s, 120s, 240s, 300s, 300s})
    {
        EXPECT_EQ(LeftAlone(), expected);
        BeginAnew();
    }
}

TEST_F(AuthenticationRetriesTest, TheFirstAttemptAfterASuccessIsShortAgain)
{
    Announce();
    BeginAnew();
    BeginAnew();
    Retries.IsAuthenticated(Sender);
    Retries.Gone(Sender);
    Announce();
    Retries.Exchanged(Sender, Step::Request, true, Now);
    EXPECT_EQ(LeftAlone(), Stalled);
}

TEST_F(AuthenticationRetriesTest, AParticipantThatAnnouncesItselfNoMoreIsNotTriedAgain)
{
    Announce();
    Retries.Exchanged(Sender, Step::Request, true, Now);
    Now += 1h;
    EXPECT_FALSE(Retries.Due(AnswerTime));
}

TEST_F(AuthenticationRetriesTest, AnAnnouncementWithOtherContentIsRefusedUntilTheParticipantIsForgotten)
{
    EXPECT_TRUE(Announce(1));
    EXPECT_FALSE(Announce(2));
    EXPECT_TRUE(Announce(1));
    Retries.Forget(Sender);
    EXPECT_TRUE(Announce(2));
    EXPECT_FALSE(Announce(1));
}

TEST_F(AuthenticationRetriesTest, AnAnnouncementWithOtherContentShortensTheTime)
{
    Announce(1);
    Announce(2);
    EXPECT_EQ(LeftAlone(), Stalled);
}

TEST_F(AuthenticationRetriesTest, AHandshakeMustSignTheContentThatWasAnnounced)
{
    Announce();
    EXPECT_TRUE(Retries.Signs(Sender, {{10}, {20}}));
    EXPECT_TRUE(Retries.Signs(Sender, {}));
    EXPECT_FALSE(Retries.Signs(Sender, {{5}, {10}, {20}}));
    EXPECT_FALSE(Retries.Signs(Sender, {{10}}));
    EXPECT_FALSE(Retries.Signs(Sender, {{10}, {30}}));
    EXPECT_TRUE(Retries.Signs(Other, {{30}}));
    EXPECT_EQ(LeftAlone(), Stalled);
}

TEST_F(AuthenticationRetriesTest, TheGoodbyeHasANumberAboveThoseOfTheAnnouncements)
{
    Announce();
    Retries.Announced(Sender, {.Digest = 1, .Number = 12}, Now);
    Retries.Announced(Sender, {.Digest = 1, .Number = 9}, Now);
    EXPECT_EQ(Retries.Forget(Sender), 13);
}

TEST_F(AuthenticationRetriesTest, AFullTableForgetsTheParticipantThatWasSilentLongest)
{
    Announce(1, Sender);
    GuidPrefix peer = Other;
    for (std::size_t i = 0; i < AuthenticationRetries::Most; ++i)
    {
        Now += 1ms;
        peer[0] = static_cast<std::uint8_t>(i);
        peer[1] = static_cast<std::uint8_t>(i >> 8);
        Announce(1, peer);
    }
    EXPECT_TRUE(Announce(2, Sender));
    EXPECT_FALSE(Announce(2, peer));
}

}  // namespace
