// When claims go out, and with which answers.
#include "envelope/ClaimExchange.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

namespace
{

using namespace std::chrono_literals;
using namespace Rabit::Envelope;
using Standing = ClaimExchange::Standing;

class ClaimExchanges : public testing::Test
{
protected:
    struct Sent
    {
        TimePoint At{};
        ClaimExchange::Outgoing Claim;
    };
    // Runs in steps of a millisecond. Returns what went out, and expects that Next said so before.
    std::vector<Sent> Run(std::chrono::milliseconds time)
    {
        std::vector<Sent> sent;
        for (const TimePoint end = Now + time; Now < end; Now += 1ms)
        {
            while (Exchange.Due() && *Exchange.Due() <= Now)
            {
                const auto next = Exchange.Next(7, Now);
                auto claim = Exchange.TakeDue(7, Now);
                EXPECT_EQ(next.has_value(), claim.has_value());
                if (next && claim)
                {
                    EXPECT_EQ(next->In, claim->In);
                    EXPECT_EQ(next->Answers, claim->Answers.size());
                    EXPECT_EQ(next->WithCertificate, claim->WithCertificate);
                    sent.push_back({.At = Now, .Claim = std::move(*claim)});
                }
            }
        }
        return sent;
    }

    TimePoint Now{1h};
    std::uint8_t Nonces = 0;
    ClaimExchange Exchange{[this] { return Nonce{++Nonces}; }};
};

TEST_F(ClaimExchanges, IntroduceTheSessionAtTheStartUntilAnotherOneIsProven)
{
    Exchange.Begin(Now);
    const auto sent = Run(1s);
    ASSERT_GE(sent.size(), 4u);
    EXPECT_LE(sent.size(), 6u);
    EXPECT_TRUE(sent[0].Claim.WithCertificate);
    EXPECT_EQ(sent[0].Claim.Challenge, Nonce{1});
    EXPECT_EQ(sent[0].Claim.In, 7);
    Exchange.Proven(5, Now);
    EXPECT_TRUE(Run(20s).empty());
}

TEST_F(ClaimExchanges, EndAfterSomeTimeWhereNobodyIs)
{
    Exchange.Begin(Now);
    EXPECT_EQ(Run(60s).size(), static_cast<std::size_t>(ClaimExchange::InitialClaims));
}

TEST_F(ClaimExchanges, AnswerManyQuestionsByOneClaim)
{
    for (std::uint8_t session = 1; session <= 9; ++session)
    {
        Exchange.Asked(session, Standing::Proven, Nonce{session, 1}, 7, Now);
    }
    const auto sent = Run(1s);
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_EQ(sent[0].Claim.Answers.size(), 9u);
    EXPECT_FALSE(sent[0].Claim.WithCertificate);
    EXPECT_EQ(sent[0].Claim.Challenge, Nonce{});
}

TEST_F(ClaimExchanges, AnswerASessionThatIsNotProvenWithTheCertificate)
{
    Exchange.Asked(1, Standing::Claimed, Nonce{9}, 7, Now);
    const auto sent = Run(1s);
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_TRUE(sent[0].Claim.WithCertificate);
}

TEST_F(ClaimExchanges, AnswerOneNonceOnceUntilItMayBeLost)
{
    Exchange.Asked(1, Standing::Proven, Nonce{9}, 7, Now);
    EXPECT_EQ(Run(25ms).size(), 1u);
    Exchange.Asked(1, Standing::Proven, Nonce{9}, 7, Now);
    EXPECT_TRUE(Run(40ms).empty());
    Exchange.Asked(1, Standing::Proven, Nonce{9}, 7, Now);
    EXPECT_EQ(Run(30ms).size(), 1u);
    Exchange.Asked(1, Standing::Proven, Nonce{8}, 7, Now);
    EXPECT_EQ(Run(30ms).size(), 1u);
}

TEST_F(ClaimExchanges, AnswerRecordedQuestionsEverMoreSeldom)
{
    std::size_t sent = 0;
    for (std::uint8_t session = 1; session <= 200; ++session)
    {
        Exchange.Asked(session, Standing::Claimed, Nonce{session}, 7, Now);
        sent += Run(50ms).size();
    }
    EXPECT_LE(sent, 35u);  // in 10 s
}

TEST_F(ClaimExchanges, AnswerVerifiedClaimsHoweverManyOthersAsk)
{
    Exchange.Asked(1, Standing::Claimed, Nonce{0, 1}, 7, Now);
    for (std::uint8_t session = 2; session <= 200; ++session)
    {
        Exchange.Asked(session, Standing::Unknown, Nonce{session}, 7, Now);
        Now += std::chrono::microseconds(50);
    }
    const auto sent = Run(100ms);
    ASSERT_EQ(sent.size(), 1u);
    const auto &answers = sent[0].Claim.Answers;
    EXPECT_EQ(answers.size(), Claim::MostAnswers);
    EXPECT_NE(std::find(answers.begin(), answers.end(), Nonce{0, 1}), answers.end());
    // Of the others, the newest are kept.
    EXPECT_NE(std::find(answers.begin(), answers.end(), Nonce{200}), answers.end());
    EXPECT_EQ(std::find(answers.begin(), answers.end(), Nonce{2}), answers.end());
}

TEST_F(ClaimExchanges, DoNotDropVerifiedClaimsForOthers)
{
    for (std::uint8_t session = 1; session <= Claim::MostAnswers; ++session)
    {
        Exchange.Asked(session, Standing::Claimed, Nonce{session}, 7, Now);
    }
    Exchange.Asked(200, Standing::Unknown, Nonce{200}, 7, Now);
    const auto sent = Run(100ms);
    ASSERT_EQ(sent.size(), 1u);
    const auto &answers = sent[0].Claim.Answers;
    EXPECT_EQ(std::find(answers.begin(), answers.end(), Nonce{200}), answers.end());
}

TEST_F(ClaimExchanges, AskASessionThatIsHeardAtGrowingIntervals)
{
    std::vector<Sent> sent;
    for (int i = 0; i < 100; ++i)
    {
        Exchange.Heard(1, Standing::Proven, 7, Now);
        const auto more = Run(100ms);
        sent.insert(sent.end(), more.begin(), more.end());
    }
    ASSERT_GE(sent.size(), 25u);
    EXPECT_LE(sent.size(), 45u);
    EXPECT_LE(sent[1].At - sent[0].At, 100ms);
    EXPECT_GE(sent.back().At - sent[sent.size() - 2].At, 300ms);
    EXPECT_NE(sent[0].Claim.Challenge, Nonce{});
    EXPECT_FALSE(sent[0].Claim.WithCertificate);
}

TEST_F(ClaimExchanges, AskAsOftenAfterALongWaitForATurn)
{
    Exchange.Heard(5, Standing::Proven, 7, Now);
    for (const TimePoint end = Now + 8s; Now < end; Now += 10ms)
    {
        Exchange.Heard(5, Standing::Proven, 7, Now);
        Exchange.Next(7, Now);
    }
    EXPECT_GE(Run(1500ms).size(), 4u);
}

TEST_F(ClaimExchanges, AskNobodyThatIsSilent)
{
    Exchange.Heard(1, Standing::Proven, 7, Now);
    Run(3s);
    EXPECT_TRUE(Run(60s).empty());
    EXPECT_FALSE(Exchange.Due().has_value());
}

TEST_F(ClaimExchanges, AskAnInventedSessionFourTimesForEachDatagram)
{
    for (int i = 0; i < 2; ++i)
    {
        Exchange.Heard(1, Standing::Unknown, 7, Now);
        EXPECT_EQ(Run(4s).size(), 4u);
        EXPECT_FALSE(Exchange.Due().has_value());
    }
    // A claim of it came, with the right tag.
    Exchange.Heard(1, Standing::Claimed, 7, Now);
    EXPECT_GE(Run(4s).size(), 8u);
}

TEST_F(ClaimExchanges, AskNobodyThatIsProven)
{
    Exchange.Heard(1, Standing::Claimed, 7, Now);
    Exchange.Proven(1, Now);
    EXPECT_TRUE(Run(60s).empty());
}

TEST_F(ClaimExchanges, AskNobodyThatIsRevoked)
{
    Exchange.Refuse(1);
    Exchange.Heard(1, Standing::Unknown, 7, Now);
    EXPECT_TRUE(Run(60s).empty());
}

TEST_F(ClaimExchanges, AskAgainAtOnceAfterALongSilence)
{
    for (int i = 0; i < 300; ++i)
    {
        Exchange.Heard(1, Standing::Proven, 7, Now);
        Run(100ms);
    }
    Run(15s);
    Exchange.Heard(1, Standing::Proven, 7, Now);
    EXPECT_GE(Run(100ms).size(), 1u);
}

TEST_F(ClaimExchanges, AskManyAtOnce)
{
    for (std::uint8_t session = 1; session <= 100; ++session)
    {
        Exchange.Heard(session, Standing::Claimed, 7, Now);
    }
    EXPECT_EQ(Run(50ms).size(), 1u);
}

TEST_F(ClaimExchanges, AskAlsoWhileSessionsAreInventedAllTheTime)
{
    std::size_t asked = 0;
    for (SessionTag session = 1; session <= 1000; ++session)
    {
        Exchange.Heard(session, Standing::Unknown, 7, Now);
        asked += Run(1ms).size();
    }
    EXPECT_GE(asked, 2u);
    EXPECT_LE(asked, 10u);
    EXPECT_LE(Exchange.Size(), ClaimExchange::MostAsked);
}

TEST_F(ClaimExchanges, ReplaceANonceThatIsFiveSecondsOld)
{
    Exchange.Heard(1, Standing::Proven, 7, Now);
    const auto first = Run(30ms);
    Exchange.Heard(1, Standing::Proven, 7, Now);
    const auto second = Run(500ms);
    Run(6s);
    Exchange.Heard(1, Standing::Proven, 7, Now);
    const auto third = Run(500ms);
    ASSERT_FALSE(first.empty() || second.empty() || third.empty());
    EXPECT_EQ(first[0].Claim.Challenge, second[0].Claim.Challenge);
    EXPECT_NE(first[0].Claim.Challenge, third[0].Claim.Challenge);
    // The nonce counts for ten seconds.
    EXPECT_TRUE(Exchange.Challenges().AnsweredBy(std::vector{second[0].Claim.Challenge}, Now).has_value());
}

TEST_F(ClaimExchanges, SpeakToEachSessionInItsEpoch)
{
    Exchange.Asked(1, Standing::Proven, Nonce{1}, 6, Now);
    Exchange.Asked(2, Standing::Proven, Nonce{2}, 7, Now);
    Exchange.Heard(3, Standing::Claimed, 5, Now);
    const auto sent = Run(60ms);
    ASSERT_EQ(sent.size(), 3u);
    std::vector<Epoch> epochs;
    for (const Sent &each : sent)
    {
        epochs.push_back(each.Claim.In);
        EXPECT_EQ(each.Claim.Challenge != Nonce{}, each.Claim.In == 5);
        EXPECT_EQ(each.Claim.Answers.size(), each.Claim.In == 5 ? 0u : 1u);
    }
    std::sort(epochs.begin(), epochs.end());
    EXPECT_EQ(epochs, (std::vector<Epoch>{5, 6, 7}));
}

TEST_F(ClaimExchanges, BringTheCertificateToASessionThatLacksIt)
{
    Exchange.WantCertificate(7, Now);
    Exchange.WantCertificate(7, Now);
    const auto sent = Run(1s);
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_TRUE(sent[0].Claim.WithCertificate);
    EXPECT_EQ(sent[0].Claim.Challenge, Nonce{});
}

}  // namespace
