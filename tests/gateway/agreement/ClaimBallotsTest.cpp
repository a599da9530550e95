#include "agreement/ClaimBallots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "agreement/ClaimMessages.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::IsEmpty;

class Ballots : public ::testing::Test
{
protected:
    ClaimRequest RequestOf(std::uint64_t incarnation, std::uint32_t renewal) const
    {
        return {.Group = _settings.Group(), .Incarnation = incarnation, .Session = 1, .Renewal = renewal};
    }
    // Sends orders to the book that the first answer names.
    ClaimReply Order(const std::string &from, ClaimOrder::Kind what, const std::string &claim,
                     std::uint64_t fence = 0)
    {
        ClaimRequest request = RequestOf(1, ++_renewal);
        request.Book = _ballots.OnRequest(from, request, _now)->Book;
        request.Number = ++_number;
        request.Orders = {{.What = what, .Fence = fence, .Name = claim}};
        _last = request;
        return _ballots.OnRequest(from, request, _now).value_or(ClaimReply());
    }

    const AgreementSettings _settings{
        .Self = "ground", .Incarnation = 5, .Members = {"ground", "uav1", "uav2"}};
    ClaimBallots _ballots{_settings, 0, 0s};
    std::chrono::nanoseconds _now = 10s;
    std::uint32_t _renewal = 0;
    std::uint32_t _number = 0;
    ClaimRequest _last;
};

TEST_F(Ballots, AnswerNobodyBeforeALeaseHasPassedSinceTheStart)
{
    EXPECT_FALSE(_ballots.OnRequest("uav1", RequestOf(1, 1), 2s));
    EXPECT_TRUE(_ballots.OnRequest("uav1", RequestOf(1, 1), 2061ms));
}

TEST_F(Ballots, AnswerNobodyWhileTheirNameIsTaken)
{
    _ballots.NameIsTaken(_now);
    EXPECT_FALSE(_ballots.OnRequest("uav1", RequestOf(1, 1), _now + 2s));
    EXPECT_TRUE(_ballots.OnRequest("uav1", RequestOf(1, 1), _now + 2061ms));
}

TEST_F(Ballots, IgnoreClaimantsThatAreNotInTheList)
{
    EXPECT_FALSE(_ballots.OnRequest("uav9", RequestOf(1, 1), _now));
}

TEST_F(Ballots, IgnoreClaimantsWithAnotherList)
{
    ClaimRequest request = RequestOf(1, 1);
    ++request.Group;
    EXPECT_FALSE(_ballots.OnRequest("uav1", request, _now));
}

TEST_F(Ballots, GrantAClaimToOne)
{
    EXPECT_EQ(Order("uav1", ClaimOrder::Kind::Ask, "cell").Results.at(0).What, ClaimResult::Kind::Granted);
    const ClaimResult refused = Order("uav2", ClaimOrder::Kind::Ask, "cell").Results.at(0);
    EXPECT_EQ(refused.What, ClaimResult::Kind::Refused);
    EXPECT_EQ(refused.Holder, "uav1");
}

TEST_F(Ballots, GrantAClaimToAnotherOneOnceItsHolderHasNotRenewed)
{
    Order("uav1", ClaimOrder::Kind::Ask, "cell");
    _now += 2059ms;
    EXPECT_EQ(Order("uav2", ClaimOrder::Kind::Ask, "cell").Results.at(0).What, ClaimResult::Kind::Refused);
    _now += 1ms;
    EXPECT_EQ(Order("uav2", ClaimOrder::Kind::Ask, "cell").Results.at(0).What, ClaimResult::Kind::Granted);
}

TEST_F(Ballots, DoNotTakeALateRenewalForANewOne)
{
    Order("uav1", ClaimOrder::Kind::Ask, "cell");
    _now += 2s;
    _ballots.OnRequest("uav1", RequestOf(1, 1), _now);
    _now += 61ms;
    EXPECT_EQ(Order("uav2", ClaimOrder::Kind::Ask, "cell").Results.at(0).What, ClaimResult::Kind::Granted);
}

TEST_F(Ballots, DoNothingForALateCopyOfAnOrder)
{
    Order("uav1", ClaimOrder::Kind::Ask, "cell");
    const ClaimRequest copy = _last;
    Order("uav1", ClaimOrder::Kind::Release, "cell");
    EXPECT_TRUE(_ballots.OnRequest("uav1", copy, _now)->Results.empty());
    EXPECT_FALSE(_ballots.HolderOf("cell", _now));
}

TEST_F(Ballots, DoNothingForAnOrderToAFormerBook)
{
    Order("uav1", ClaimOrder::Kind::Ask, "cell");
    ClaimRequest late = _last;
    _now += 10s;
    EXPECT_TRUE(_ballots.OnRequest("uav1", late, _now)->Results.empty());
    EXPECT_FALSE(_ballots.HolderOf("cell", _now));
}

TEST_F(Ballots, KeepTheClaimsOfAFormerLifeUntilItsLeaseEnds)
{
    Order("uav1", ClaimOrder::Kind::Ask, "cell");
    ClaimRequest second = RequestOf(2, 1);
    second.Book = _ballots.OnRequest("uav1", second, _now)->Book;
    second.Number = 1;
    second.Orders = {{.What = ClaimOrder::Kind::Ask, .Name = "cell"}};
    EXPECT_EQ(_ballots.OnRequest("uav1", second, _now)->Results.at(0).What, ClaimResult::Kind::Refused);
}

TEST_F(Ballots, IgnoreAFormerLife)
{
    _ballots.OnRequest("uav1", RequestOf(2, 1), _now);
    EXPECT_FALSE(_ballots.OnRequest("uav1", RequestOf(1, 1), _now));
}

TEST_F(Ballots, AcceptNoFenceWithoutAGrant)
{
    const ClaimReply reply = Order("uav1", ClaimOrder::Kind::Accept, "cell", 7);
    EXPECT_EQ(reply.Results.at(0).What, ClaimResult::Kind::Refused);
    EXPECT_EQ(reply.Fences, 0U);
}

TEST_F(Ballots, StoreAFenceBeforeItIsUsed)
{
    Order("uav1", ClaimOrder::Kind::Ask, "cell");
    EXPECT_FALSE(_ballots.StoreWanted());
    EXPECT_THAT(Order("uav1", ClaimOrder::Kind::Accept, "cell", 7).Results, IsEmpty());
    bool waits = false;
    EXPECT_FALSE(_ballots.OnRequest("uav1", _last, _now, &waits));
    EXPECT_TRUE(waits);
    const auto upTo = _ballots.StoreWanted();
    ASSERT_TRUE(upTo);
    EXPECT_GE(*upTo, 7U);
    _ballots.Stored(*upTo, true);
    const auto reply = _ballots.OnRequest("uav1", _last, _now);
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->Results.at(0).What, ClaimResult::Kind::Accepted);
    EXPECT_EQ(reply->Fences, 7U);
    EXPECT_FALSE(_ballots.StoreWanted());
}

TEST_F(Ballots, RefuseAFenceThatCouldNotBeStoredUntilItIs)
{
    Order("uav1", ClaimOrder::Kind::Ask, "cell");
    Order("uav1", ClaimOrder::Kind::Accept, "cell", 7);
    const auto upTo = _ballots.StoreWanted();
    ASSERT_TRUE(upTo);
    _ballots.Stored(*upTo, false);
    EXPECT_EQ(Order("uav1", ClaimOrder::Kind::Accept, "cell", 7).Results.at(0).What,
              ClaimResult::Kind::Refused);
    EXPECT_EQ(_ballots.StoreWanted(), upTo);
    _ballots.Stored(*upTo, true);
    EXPECT_EQ(Order("uav1", ClaimOrder::Kind::Accept, "cell", 7).Results.at(0).What,
              ClaimResult::Kind::Accepted);
}

TEST_F(Ballots, RefuseAFenceFarAboveAllThatTheyKnow)
{
    Order("uav1", ClaimOrder::Kind::Ask, "cell");
    EXPECT_EQ(Order("uav1", ClaimOrder::Kind::Accept, "cell", ~std::uint64_t{0}).Results.at(0).What,
              ClaimResult::Kind::Refused);
}

TEST_F(Ballots, RefuseMoreClaimsThanOneMayHave)
{
    for (std::size_t i = 0; i < AgreementSettings::MostClaims; ++i)
    {
        ASSERT_EQ(Order("uav1", ClaimOrder::Kind::Ask, "cell " + std::to_string(i)).Results.at(0).What,
                  ClaimResult::Kind::Granted);
    }
    EXPECT_EQ(Order("uav1", ClaimOrder::Kind::Ask, "one more").Results.at(0).What,
              ClaimResult::Kind::Refused);
    Order("uav1", ClaimOrder::Kind::Release, "cell 0");
    EXPECT_EQ(Order("uav1", ClaimOrder::Kind::Ask, "one more").Results.at(0).What,
              ClaimResult::Kind::Granted);
}

TEST(ClaimMessages, AreReadAsTheyWereWritten)
{
    const ClaimRequest request{.Group = 1,
                               .Incarnation = 2,
                               .Session = 3,
                               .Renewal = 4,
                               .Book = 5,
                               .Number = 6,
                               .Orders = {{.What = ClaimOrder::Kind::Accept, .Fence = 7, .Name = "cell"},
                                          {.What = ClaimOrder::Kind::Release, .Name = "leader"}}};
    EXPECT_EQ(DecodeClaimRequest(EncodeClaimRequest(request)), request);
    const ClaimReply reply{
        .Group = 1,
        .Incarnation = 2,
        .Claimant = 3,
        .Session = 4,
        .Book = 5,
        .Renewal = 6,
        .Number = 7,
        .Fences = 8,
        .Results = {
            {.What = ClaimResult::Kind::Refused, .Milliseconds = 9, .Name = "cell", .Holder = "uav1"}}};
    EXPECT_EQ(DecodeClaimReply(EncodeClaimReply(reply)), reply);
}

TEST(ClaimMessages, AreRefusedIfBytesAreMissingOrLeft)
{
    const auto bytes = EncodeClaimRequest({.Orders = {{.Name = "cell"}}});
    ASSERT_TRUE(DecodeClaimRequest(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size)
    {
        EXPECT_FALSE(DecodeClaimRequest(std::span(bytes).first(size))) << size;
    }
    auto longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(DecodeClaimRequest(longer));
}

TEST(ClaimMessages, FitInADatagramWithTheLongestNames)
{
    ClaimReply reply;
    for (std::size_t i = 0; i < ClaimRequest::MostOrders; ++i)
    {
        reply.Results.push_back({.Name = std::string(64, 'n'), .Holder = std::string(200, 'h')});
    }
    ASSERT_TRUE(DecodeClaimReply(EncodeClaimReply(reply)));
    EXPECT_LE(EncodeClaimReply(reply).size(), 1200U);
}

TEST(ClaimMessages, AreRefusedWithAnEmptyOrALongName)
{
    EXPECT_FALSE(DecodeClaimRequest(EncodeClaimRequest({.Orders = {{.Name = ""}}})));
    EXPECT_FALSE(DecodeClaimRequest(EncodeClaimRequest({.Orders = {{.Name = std::string(65, 'x')}}})));
    EXPECT_TRUE(DecodeClaimRequest(EncodeClaimRequest({.Orders = {{.Name = std::string(64, 'x')}}})));
}

}  // namespace
}  // namespace Rabit
