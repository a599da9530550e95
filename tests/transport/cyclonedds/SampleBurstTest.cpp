#include "SampleBurst.h"

#include <gtest/gtest.h>

namespace Rabit::Cyclone
{
namespace
{

using namespace std::chrono_literals;

constexpr std::size_t Datagram = 1024;
constexpr std::size_t InBurst = SampleBurst::Largest / Datagram;
constexpr SampleBurst::TimePoint Start{1h};

// Returns the sum of the pauses after that many datagrams at once.
std::chrono::milliseconds PausesAfter(SampleBurst &burst, std::size_t datagrams, SampleBurst::TimePoint now)
{
    std::chrono::milliseconds sum{0};
    for (std::size_t i = 0; i < datagrams; ++i)
    {
        sum += burst.Sent(Datagram, now + sum);
    }
    return sum;
}

TEST(SampleBurst, SmallSamplesGoWithoutAPause)
{
    SampleBurst burst;
    EXPECT_EQ(PausesAfter(burst, InBurst - 1, Start), 0ms);
}

TEST(SampleBurst, ALargeSampleIsSpreadEvenly)
{
    SampleBurst burst;
    EXPECT_EQ(PausesAfter(burst, InBurst, Start), SampleBurst::Pause);
    EXPECT_EQ(PausesAfter(burst, 60 * InBurst, Start + 10ms), 60 * SampleBurst::Pause);
}

TEST(SampleBurst, AfterAPauseOfItsOwnTheThreadBeginsAnew)
{
    SampleBurst burst;
    EXPECT_EQ(PausesAfter(burst, InBurst - 1, Start), 0ms);
    EXPECT_EQ(PausesAfter(burst, InBurst - 1, Start + SampleBurst::Pause), 0ms);
}

TEST(SampleBurst, ASlowThreadNeverWaits)
{
    SampleBurst burst;
    for (std::size_t i = 0; i < 10 * InBurst; ++i)
    {
        EXPECT_EQ(burst.Sent(Datagram, Start + i * SampleBurst::Pause), 0ms);
    }
}

}  // namespace
}  // namespace Rabit::Cyclone
