#include "agreement/ClaimVotes.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "agreement/AgreementSettings.h"
#include "agreement/ClaimLease.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

class Votes : public ::testing::Test
{
protected:
    // Gives the present order to a voter, which answers it.
    bool Answer(const std::string &voter, ClaimResult::Kind what, std::uint64_t fences = 0)
    {
        _votes.Sent(voter, ++_number);
        return _votes.Take(voter, _number, fences, {.What = what, .Name = "cell"});
    }

    ClaimVotes _votes{"cell", {"a", "b", "c"}};
    std::uint32_t _number = 0;
};

TEST_F(Votes, TakeAFenceAboveAllThatTheVotersKnow)
{
    _votes.Ask();
    Answer("a", ClaimResult::Kind::Granted, 7);
    Answer("b", ClaimResult::Kind::Granted, 3);
    _votes.Accept();
    EXPECT_EQ(_votes.OrderTo("b")->Fence, 8U);
}

// A former holder may have had the fence that only the late voter knows.
TEST_F(Votes, RaiseTheFenceIfAVoterThatGrantsLaterKnowsAHigherOne)
{
    _votes.Ask();
    Answer("a", ClaimResult::Kind::Granted);
    Answer("b", ClaimResult::Kind::Granted);
    _votes.Accept();
    Answer("a", ClaimResult::Kind::Accepted);
    EXPECT_TRUE(Answer("c", ClaimResult::Kind::Granted, 5));
    EXPECT_EQ(_votes.Fence(), 6U);
    EXPECT_EQ(_votes.Count(ClaimVotes::Kind::Accepted), 0U);
    EXPECT_EQ(_votes.OrderTo("a")->Fence, 6U);
}

TEST_F(Votes, KeepTheFenceOfAClaimThatIsHeld)
{
    _votes.Ask();
    Answer("a", ClaimResult::Kind::Granted);
    Answer("b", ClaimResult::Kind::Granted);
    _votes.Accept();
    Answer("a", ClaimResult::Kind::Accepted);
    Answer("b", ClaimResult::Kind::Accepted);
    _votes.Hold();
    EXPECT_FALSE(Answer("c", ClaimResult::Kind::Granted, 5));
    EXPECT_EQ(_votes.Fence(), 1U);
    EXPECT_EQ(_votes.Count(ClaimVotes::Kind::Accepted), 2U);
}

TEST_F(Votes, DoNotTakeAnAnswerToAnEarlierOrder)
{
    _votes.Ask();
    _votes.Sent("a", 1);
    _votes.Release();
    _votes.Ask();
    _votes.Sent("a", 2);
    _votes.Take("a", 1, 0, {.What = ClaimResult::Kind::Granted, .Name = "cell"});
    EXPECT_EQ(_votes.Count(ClaimVotes::Kind::Granted), 0U);
}

// A copy of the Ask may be on its way while the answer to the first one says that it was refused.
TEST_F(Votes, TakeBackAnAskThatWasRefused)
{
    _votes.Ask();
    Answer("a", ClaimResult::Kind::Refused);
    _votes.Release();
    ASSERT_TRUE(_votes.OrderTo("a"));
    EXPECT_EQ(_votes.OrderTo("a")->What, ClaimOrder::Kind::Release);
    Answer("a", ClaimResult::Kind::Released);
    EXPECT_FALSE(_votes.OrderTo("a"));
}

TEST_F(Votes, TakeNothingBackFromAVoterThatWasNotAsked)
{
    _votes.Ask();
    _votes.Release();
    EXPECT_FALSE(_votes.OrderTo("a"));
}

class Leases : public ::testing::Test
{
protected:
    ClaimReply ReplyTo(const ClaimRequest &request, std::uint64_t book = 1) const
    {
        return {.Group = request.Group,
                .Incarnation = 1,
                .Claimant = request.Incarnation,
                .Session = request.Session,
                .Book = book,
                .Renewal = request.Renewal};
    }

    const AgreementSettings _settings{.Self = "a", .Incarnation = 1, .Members = {"a", "b", "c"}};
    ClaimLease _lease{_settings};
};

TEST_F(Leases, LastFromWhenTheAcknowledgedRenewalWasSent)
{
    const ClaimRequest first = _lease.Renew(10s);
    _lease.Renew(11s);
    _lease.Take("b", ReplyTo(first), 10s);
    EXPECT_EQ(_lease.UntilOf("b"), 12s);
}

TEST_F(Leases, AreNotLongerByANumberThatWasNotSent)
{
    ClaimRequest request = _lease.Renew(10s);
    ++request.Renewal;
    _lease.Take("b", ReplyTo(request), 10s);
    EXPECT_EQ(_lease.UntilOf("b"), 0s);
}

TEST_F(Leases, AreNotLongerByAnAnswerForAFormerSession)
{
    const ClaimRequest former = _lease.Renew(10s);
    _lease.EndSession();
    _lease.Renew(10s);
    EXPECT_EQ(_lease.Take("b", ReplyTo(former), 10s), ClaimLease::Answer::Ignored);
}

TEST_F(Leases, IgnoreAnAnswerFromAFormerBook)
{
    const ClaimRequest request = _lease.Renew(10s);
    EXPECT_EQ(_lease.Take("b", ReplyTo(request, 2), 10s), ClaimLease::Answer::OfNewBook);
    EXPECT_EQ(_lease.Take("b", ReplyTo(request, 2), 10s), ClaimLease::Answer::OfKnownBook);
    EXPECT_EQ(_lease.Take("b", ReplyTo(request, 1), 10s), ClaimLease::Answer::Ignored);
}

TEST_F(Leases, TakeALowerIncarnationOfAVoterOnceItsLeaseHasPassed)
{
    const ClaimRequest request = _lease.Renew(10s);
    _lease.Take("b", ReplyTo(request, 2), 10s);
    EXPECT_EQ(_lease.Take("b", ReplyTo(request, 1), 12s), ClaimLease::Answer::OfNewBook);
}

TEST_F(Leases, CountAMajorityAlone)
{
    const ClaimRequest request = _lease.Renew(10s);
    _lease.Take("b", ReplyTo(request), 10s);
    EXPECT_EQ(_lease.UntilOf(std::vector<std::string_view>{"b"}), 0s);
    _lease.Take("c", ReplyTo(request), 10s);
    EXPECT_EQ(_lease.UntilOf(std::vector<std::string_view>{"b", "c"}), 12s);
}

TEST_F(Leases, AreRenewedMoreAndMoreRarelyWithoutAMajority)
{
    std::chrono::nanoseconds now = 10s;
    for (int i = 0; i < 30; ++i)
    {
        _lease.Renew(now);
        now = *_lease.RenewAt();
    }
    _lease.Renew(now);
    EXPECT_EQ(*_lease.RenewAt() - now, 2s);
}

// Else the acknowledged lease ends before its next renewal.
TEST_F(Leases, AreRenewedInTimeOnceAMajorityAnswersAgain)
{
    std::chrono::nanoseconds now = 10s;
    for (int i = 0; i < 30; ++i)
    {
        _lease.Renew(now);
        now = *_lease.RenewAt();
    }
    const ClaimRequest request = _lease.Renew(now);
    _lease.Take("b", ReplyTo(request), now);
    _lease.Take("c", ReplyTo(request), now);
    EXPECT_EQ(*_lease.RenewAt() - now, 500ms);
}

// 64 voters with orders each 100 ms send more renewals in a lease than voters acknowledge.
TEST_F(Leases, KnowWhenEachRenewalOfALeaseWasSent)
{
    const ClaimRequest first = _lease.Renew(10s);
    for (int i = 0; i < 1300; ++i)
    {
        _lease.OrdersTo("c", 10s);
    }
    _lease.Take("b", ReplyTo(first), 10s);
    EXPECT_EQ(_lease.UntilOf("b"), 12s);
}

}  // namespace
}  // namespace Rabit
