#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "common/DiscoveryPace.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(DiscoveryPace, HandsOutWhatPeersSayOnceAndInTheirOrder)
{
    DiscoveryPace pace;
    pace.CameLate(5ms);
    pace.CameLate(400ms);
    EXPECT_THAT(pace.TakeLate(), ElementsAre(5ms, 400ms));
    EXPECT_THAT(pace.TakeLate(), IsEmpty());
}

TEST(DiscoveryPace, KeepsTheNewestOfWhatNobodyTakes)
{
    DiscoveryPace pace;
    const int count = static_cast<int>(DiscoveryPace::MostLate) + 3;
    for (int number = 1; number <= count; ++number)
    {
        pace.CameLate(std::chrono::milliseconds(number));
    }
    const auto late = pace.TakeLate();
    ASSERT_EQ(late.size(), DiscoveryPace::MostLate);
    EXPECT_EQ(late.front(), 4ms);
    EXPECT_EQ(late.back(), std::chrono::milliseconds(count));
}

TEST(DiscoveryPace, CountsFromWhenTheNextOneWasHeldUp)
{
    DiscoveryPace pace;
    const DiscoveryPace::TimePoint start(1h);
    EXPECT_EQ(pace.HeldUp(start), 0ns);
    pace.SetHeldUpSince(start);
    EXPECT_EQ(pace.HeldUp(start + 2s), 2s);
    pace.SetHeldUpSince({});
    EXPECT_EQ(pace.HeldUp(start + 3s), 0ns);
}

TEST(DiscoveryPace, IsNotHeldUpByWhatIsDueLater)
{
    DiscoveryPace pace;
    const DiscoveryPace::TimePoint start(1h);
    pace.SetHeldUpSince(start + 1s);
    EXPECT_EQ(pace.HeldUp(start), 0ns);
}

}  // namespace
}  // namespace Rabit
