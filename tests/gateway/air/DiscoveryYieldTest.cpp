#include "air/DiscoveryYield.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(DiscoveryYield, NothingIsHeldBackForWhatIsHeldUpShortly)
{
    DiscoveryYield yield;
    EXPECT_EQ(yield.LeastGap(0ms, 0s), 0s);
    EXPECT_EQ(yield.LeastGap(DiscoveryYield::Patience - 1ms, 1s), 0s);
}

TEST(DiscoveryYield, HoldsBackWhileDiscoveryIsHeldUpForLong)
{
    DiscoveryYield yield;
    for (auto at = 1s; at < 20s; at += 1s)
    {
        EXPECT_EQ(yield.LeastGap(DiscoveryYield::Patience, at), DiscoveryYield::Gap);
    }
}

TEST(DiscoveryYield, HoldsBackForAWhileAfter)
{
    DiscoveryYield yield;
    yield.LeastGap(DiscoveryYield::Patience, 1s);
    EXPECT_EQ(yield.LeastGap(0s, 1s + DiscoveryYield::Rest - 1ms), DiscoveryYield::Gap);
    EXPECT_EQ(yield.LeastGap(0s, 1s + DiscoveryYield::Rest), 0s);
}

TEST(DiscoveryYield, DoesNotHoldBackForEver)
{
    DiscoveryYield yield;
    for (auto at = 0s; at < DiscoveryYield::Longest; at += 1s)
    {
        EXPECT_EQ(yield.LeastGap(DiscoveryYield::Patience, at), DiscoveryYield::Gap);
    }
    for (auto at = DiscoveryYield::Longest; at < 100s; at += 1s)
    {
        EXPECT_EQ(yield.LeastGap(DiscoveryYield::Patience, at), 0s);
    }
}

TEST(DiscoveryYield, HoldsBackAnewOnceDiscoveryWasFree)
{
    DiscoveryYield yield;
    for (auto at = 0s; at < 100s; at += 1s)
    {
        yield.LeastGap(DiscoveryYield::Patience, at);
    }
    yield.LeastGap(0s, 100s);
    EXPECT_EQ(yield.LeastGap(DiscoveryYield::Patience, 101s), DiscoveryYield::Gap);
}

}  // namespace
}  // namespace Rabit
