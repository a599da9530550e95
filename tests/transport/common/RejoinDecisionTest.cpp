// When a session joins the network anew, rule by rule.
#include "common/RejoinDecision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <vector>

#include "Networks.h"

namespace
{

using namespace Rabit;
using namespace std::chrono_literals;
using std::chrono::milliseconds;

const HostNetwork Wired = Network(2, "eth0", "10.0.0.1");
const HostNetwork Radio = Network(3, "radio0", "10.1.0.1");

// A session on a host whose networks the test changes, under the test's time.
class RejoinDecisionTest : public testing::Test
{
protected:
    using Networks = std::vector<HostNetwork>;

    // Sets the host's networks. All running ones are usable; loopback only if there is no other.
    void Host(Networks networks)
    {
        _host = std::move(networks);
        _usable.clear();
        std::copy_if(_host.begin(), _host.end(), std::back_inserter(_usable),
                     [](const HostNetwork &network)
                     { return network.Running && !network.Address.empty() && !network.Loopback; });
        if (_usable.empty())
        {
            std::copy_if(_host.begin(), _host.end(), std::back_inserter(_usable),
                         [](const HostNetwork &network) { return network.Running; });
        }
    }
    void NotToBeUsed(const HostNetwork &network)
    {
        std::erase_if(_usable, [&](const HostNetwork &usable) { return usable.IsSame(network); });
    }
    void Peers(std::vector<PeerPlace> peers) { _peers = std::move(peers); }

    RejoinDecision::Verdict Look() { return _decision.Look(_now, {_host, _usable, _peers, _peersResolved}); }
    // Looks at the times that the decision asks for, and joins when it says so. Returns the time until the
    // join, or nothing if there is none.
    std::optional<milliseconds> JoinsAfter()
    {
        const auto start = _now;
        for (int looks = 0; looks < MostLooks; ++looks)
        {
            const auto verdict = Look();
            if (verdict.Join)
            {
                _decision.Joined(_now, _usable);
                return std::chrono::duration_cast<milliseconds>(_now - start);
            }
            if (!verdict.Again)
            {
                return std::nullopt;
            }
            EXPECT_GT(*verdict.Again, _now);
            _now = *verdict.Again;
        }
        ADD_FAILURE() << "it looks without end";
        return std::nullopt;
    }
    // Joins with the host's networks, then lets an hour pass.
    void JoinedLongAgo()
    {
        Look();
        _decision.Joined(_now, _usable);
        _now += 1h;
        EXPECT_FALSE(Look().Join);
    }
    void Pass(milliseconds time) { _now += time; }

    static constexpr int MostLooks = 100;

    RejoinTimes _times;
    RejoinDecision _decision{_times};
    RejoinDecision::TimePoint _now{1000h};
    Networks _host;
    Networks _usable;
    std::vector<PeerPlace> _peers;
    bool _peersResolved = false;
};

TEST_F(RejoinDecisionTest, TheFirstNetworkIsJoinedAtOnce)
{
    Host({});
    EXPECT_EQ(JoinsAfter(), std::nullopt);
    Host({Radio});
    EXPECT_EQ(JoinsAfter(), 0ms);
    EXPECT_EQ(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, ANetworkThatComesIsJoinedWhenItHasLasted)
{
    Host({Wired});
    JoinedLongAgo();
    Host({Wired, Radio});
    EXPECT_EQ(JoinsAfter(), _times.Settle);
}

TEST_F(RejoinDecisionTest, ANetworkThatDoesNotLastIsNotJoined)
{
    Host({Wired});
    JoinedLongAgo();
    Host({Wired, Radio});
    EXPECT_FALSE(Look().Join);
    Pass(_times.Settle - 1ms);
    EXPECT_FALSE(Look().Join);
    Host({Wired});
    EXPECT_EQ(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, AnotherAddressOfAnInterfaceIsANetworkThatComes)
{
    Host({Wired});
    JoinedLongAgo();
    Host({Network(Wired.Index, Wired.Interface, "10.0.0.9")});
    EXPECT_NE(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, AnotherInterfaceOfTheSameNameAndAddressIsANetworkThatComes)
{
    Host({Wired});
    JoinedLongAgo();
    Host({Network(7, Wired.Interface, Wired.Address)});
    EXPECT_NE(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, ARenamedInterfaceIsTheSame)
{
    Host({Wired});
    JoinedLongAgo();
    Host({Network(Wired.Index, "lan0", Wired.Address)});
    EXPECT_EQ(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, ANetworkThatGoesAndReturnsNeedsNothing)
{
    for (const HostNetwork &worse :
         {WithoutCarrier(Radio), SwitchedOff(Radio), Network(Radio.Index, "radio0", "")})
    {
        Host({Wired, Radio});
        JoinedLongAgo();
        Host({Wired, worse});
        EXPECT_EQ(JoinsAfter(), std::nullopt);
        Pass(1h);
        Host({Wired, Radio});
        EXPECT_EQ(JoinsAfter(), std::nullopt);
    }
}

TEST_F(RejoinDecisionTest, ANetworkThatGoesWithItsPeersNeedsNothing)
{
    Host({Wired, Radio});
    Peers({{"10.0.0.2"}, {"10.1.0.2"}});
    JoinedLongAgo();
    Host({Wired});
    EXPECT_EQ(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, ANetworkThatGoesIsLeftIfAPeerIsOnAnotherTooOnceItHasLasted)
{
    Host({Wired, Radio});
    Peers({{"10.0.0.2", "10.1.0.2"}});
    JoinedLongAgo();
    Host({Wired, WithoutCarrier(Radio)});
    EXPECT_EQ(JoinsAfter(), _times.LostFor);
    Host({Wired, Radio});
    EXPECT_NE(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, ANetworkThatGoesForAMomentIsNotLeft)
{
    Host({Wired, Radio});
    Peers({{"10.0.0.2", "10.1.0.2"}});
    JoinedLongAgo();
    Host({Wired, WithoutCarrier(Radio)});
    EXPECT_FALSE(Look().Join);
    Pass(_times.LostFor - 1ms);
    Host({Wired, Radio});
    EXPECT_EQ(JoinsAfter(), std::nullopt);
    Host({Wired, WithoutCarrier(Radio)});
    EXPECT_EQ(JoinsAfter(), _times.LostFor);
}

TEST_F(RejoinDecisionTest, ANetworkThatGoesIsLeftIfAPeerIsBehindARouter)
{
    Host({Wired, Radio});
    Peers({{"192.168.0.2"}});
    JoinedLongAgo();
    Host({Wired});
    EXPECT_EQ(JoinsAfter(), _times.LostFor);
}

TEST_F(RejoinDecisionTest, AnAddressThatGoesIsLeftIfAnotherProcessOfThisHostHadIt)
{
    Host({Wired, Radio});
    Peers({{"10.0.0.1", "10.1.0.1"}});
    JoinedLongAgo();
    Host({Wired, WithoutCarrier(Radio)});
    EXPECT_EQ(JoinsAfter(), std::nullopt);  // this host still reaches it
    Host({Wired});
    EXPECT_NE(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, APeerWithAnAddressOfThisHostAndOneElsewhereIsNotOnThatNetwork)
{
    Host({Wired, Radio});
    Peers({{"10.1.0.1", "10.0.0.2"}});
    JoinedLongAgo();
    Host({Wired});
    EXPECT_EQ(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, LoopbackIsJoinedWhenNothingElseIsThereForAWhile)
{
    Host({Loopback(), Wired});
    JoinedLongAgo();
    Host({Loopback()});
    EXPECT_EQ(JoinsAfter(), _times.LostFor);
    Host({Loopback(), Wired});
    EXPECT_NE(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, LoopbackIsNotJoinedForALostCarrier)
{
    Host({Loopback(), Wired});
    JoinedLongAgo();
    Host({Loopback(), WithoutCarrier(Wired)});
    EXPECT_EQ(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, LoopbackIsNotJoinedForAnAddressThatReturnsInTime)
{
    Host({Loopback(), Wired});
    JoinedLongAgo();
    Host({Loopback()});
    EXPECT_FALSE(Look().Join);
    Pass(_times.LostFor - 1ms);
    Host({Loopback(), Wired});
    EXPECT_EQ(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, ANetworkThatIsThereAndNotToBeUsedIsLeft)
{
    Host({Wired, Radio});
    JoinedLongAgo();
    NotToBeUsed(Wired);
    EXPECT_EQ(JoinsAfter(), 0ms);
    EXPECT_EQ(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, TheOnlyNetworkIsNotLeft)
{
    Host({Wired});
    JoinedLongAgo();
    NotToBeUsed(Wired);
    EXPECT_EQ(JoinsAfter(), std::nullopt);
}

TEST_F(RejoinDecisionTest, APeerThatHasGotAnAddressIsAReason)
{
    Host({Wired});
    JoinedLongAgo();
    _peersResolved = true;
    EXPECT_EQ(JoinsAfter(), 0ms);
}

TEST_F(RejoinDecisionTest, BetweenTwoTimesThereIsSpacing)
{
    Host({Wired});
    JoinedLongAgo();
    Host({Wired, Radio});
    EXPECT_EQ(JoinsAfter(), _times.Settle);
    Host({Wired, Radio, Network(4, "eth1", "10.2.0.1")});
    EXPECT_EQ(JoinsAfter(), _times.Spacing);
}

TEST_F(RejoinDecisionTest, AnInterfaceThatComesAndGoesIsJoinedLaterAndLater)
{
    Host({Wired});
    JoinedLongAgo();
    milliseconds settle = _times.Settle;
    for (unsigned index = 10; index < 14; ++index)
    {
        Host({Wired, Network(index, "usb0", "10.3.0.1")});
        EXPECT_EQ(JoinsAfter(), settle);
        Pass(5s);
        Host({Wired});
        EXPECT_EQ(JoinsAfter(), std::nullopt);
        settle *= 2;
    }
    // The unsteady interface does not make another one wait.
    Host({Wired, Radio});
    EXPECT_EQ(JoinsAfter(), _times.Settle);
}

TEST_F(RejoinDecisionTest, AnInterfaceIsNeverMadeToWaitForEver)
{
    Host({Wired});
    JoinedLongAgo();
    for (unsigned index = 10; index < 30; ++index)
    {
        Host({Wired, Network(index, "usb0", "10.3.0.1")});
        EXPECT_FALSE(Look().Join);
        Host({Wired});
        EXPECT_FALSE(Look().Join);
    }
    Host({Wired, Network(30, "usb0", "10.3.0.1")});
    EXPECT_EQ(JoinsAfter(), _times.LongestSettle);
}

TEST_F(RejoinDecisionTest, WhatAnInterfaceDidLongAgoIsForgotten)
{
    Host({Wired, Radio});
    JoinedLongAgo();
    Host({Wired});
    Look();
    Pass(_times.Memory + 1ms);
    Host({Wired, Network(9, "radio0", "10.1.0.9")});
    EXPECT_EQ(JoinsAfter(), _times.Settle);
}

TEST_F(RejoinDecisionTest, AfterAFailureItTriesAgainLaterAndLater)
{
    Host({Wired});
    for (const auto wait : {_times.Retry, 2 * _times.Retry, 4 * _times.Retry, _times.LongestRetry})
    {
        _decision.Failed(_now);
        EXPECT_FALSE(Look().Join);
        Pass(wait - 1ms);
        EXPECT_FALSE(Look().Join);
        Pass(1ms);
        EXPECT_TRUE(Look().Join);
    }
    _decision.Joined(_now, {Wired});
    _decision.Failed(_now);
    EXPECT_EQ(JoinsAfter(), _times.Retry);
}

}  // namespace
