#include "ConnectionGate.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{
using Ground::ConnectionGate;
using Id = ConnectionGate::Id;

const ConnectionGate::Address Stranger = boost::asio::ip::make_address("10.0.0.66");
const ConnectionGate::Address Friend = boost::asio::ip::make_address("10.0.0.7");
const ConnectionGate::Address Here = boost::asio::ip::make_address("127.0.0.1");

class ConnectionGateTest : public testing::Test
{
protected:
    ConnectionGate _gate{{.Most = 8, .MostIdle = 3, .MostOfOne = 5, .ForKnown = 2}};

    // Returns a connection that has opened its page.
    Id OpenPage(const ConnectionGate::Address &from)
    {
        const Id id = _gate.Arrive(from).Taken.value_or(0);
        _gate.OpensPage(id);
        return id;
    }
};

TEST_F(ConnectionGateTest, TakesWhatThereIsRoomFor)
{
    const auto decision = _gate.Arrive(Stranger);
    EXPECT_TRUE(decision.Taken);
    EXPECT_FALSE(decision.Dropped);
    EXPECT_EQ(_gate.Open(), 1u);
    _gate.Leaves(*decision.Taken);
    EXPECT_EQ(_gate.Open(), 0u);
}

TEST_F(ConnectionGateTest, DropsTheOldestIdleOneWhenThereAreTooMany)
{
    const Id first = *_gate.Arrive(Stranger).Taken;
    const Id second = *_gate.Arrive(Stranger).Taken;
    _gate.Arrive(Stranger);
    _gate.BecomesBusy(first);
    _gate.BecomesIdle(first);  // it was of use meanwhile
    const auto decision = _gate.Arrive(Stranger);
    EXPECT_TRUE(decision.Taken);
    EXPECT_EQ(decision.Dropped, second);
    EXPECT_EQ(_gate.Open(), 3u);
}

TEST_F(ConnectionGateTest, DropsThoseOfTheAddressThatHoldsTheMostIdleOnes)
{
    const Id theFriends = *_gate.Arrive(Friend).Taken;
    const Id first = *_gate.Arrive(Stranger).Taken;
    _gate.Arrive(Stranger);
    EXPECT_EQ(_gate.Arrive(Friend).Dropped, first);
    _gate.BecomesBusy(theFriends);
    EXPECT_EQ(_gate.Open(), 3u);
}

TEST_F(ConnectionGateTest, NeverDropsAPageOrARequestThatIsBeingAnswered)
{
    for (int i = 0; i < 4; ++i)
        ASSERT_NE(OpenPage(Here), 0u);
    for (int i = 0; i < 4; ++i)
        _gate.BecomesBusy(*_gate.Arrive(Here).Taken);
    const auto decision = _gate.Arrive(Here);
    EXPECT_FALSE(decision.Taken);
    EXPECT_FALSE(decision.Dropped);
    EXPECT_EQ(_gate.Open(), 8u);
}

TEST_F(ConnectionGateTest, BoundsWhatOneAddressHoldsButNotThisMachine)
{
    for (int i = 0; i < 5; ++i)
        _gate.BecomesBusy(*_gate.Arrive(Stranger).Taken);
    EXPECT_FALSE(_gate.Arrive(Stranger).Taken);
    EXPECT_TRUE(_gate.Arrive(Friend).Taken);
    ConnectionGate here{{.Most = 8, .MostIdle = 3, .MostOfOne = 5, .ForKnown = 2}};
    for (int i = 0; i < 8; ++i)
    {
        const auto decision = here.Arrive(Here);
        ASSERT_TRUE(decision.Taken);
        here.BecomesBusy(*decision.Taken);
    }
}

TEST_F(ConnectionGateTest, KeepsPlacesForThoseThatOpenedAPageWhileThereWasRoom)
{
    _gate.Leaves(OpenPage(Friend));
    for (int i = 0; i < 5; ++i)
        _gate.BecomesBusy(*_gate.Arrive(Stranger).Taken);
    const auto other = boost::asio::ip::make_address("10.0.0.67");
    _gate.BecomesBusy(*_gate.Arrive(other).Taken);
    EXPECT_FALSE(_gate.Arrive(other).Taken) << "the last two places are not for strangers";
    EXPECT_NE(OpenPage(Friend), 0u);
    EXPECT_NE(OpenPage(Here), 0u) << "this machine is known";
    EXPECT_FALSE(_gate.Arrive(Here).Taken);
}

TEST_F(ConnectionGateTest, DoesNotLearnAStrangerWhoComesInACrowd)
{
    for (int i = 0; i < 5; ++i)
        OpenPage(Here);
    OpenPage(Stranger);
    EXPECT_EQ(OpenPage(Stranger), 0u);
}

TEST_F(ConnectionGateTest, IgnoresWhatIsNotThere)
{
    _gate.BecomesIdle(99);
    _gate.BecomesBusy(99);
    _gate.OpensPage(99);
    _gate.Leaves(99);
    EXPECT_EQ(_gate.Open(), 0u);
}
}  // namespace
