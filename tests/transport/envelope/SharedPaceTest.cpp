// How many bytes of introductions a session sends, by the number of nodes that it hears.
#include "envelope/SharedPace.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>

namespace
{

using namespace std::chrono_literals;
using namespace Rabit::Envelope;

class SharedPaces : public testing::Test
{
protected:
    // Sends datagrams of 500 bytes with their headers, as soon as each is free, while `others` nodes are
    // heard each 500 ms. Returns the bytes a second.
    double RateBeside(Serial others)
    {
        constexpr std::size_t size = 500;
        constexpr std::chrono::seconds time{60};
        std::size_t bytes = 0;
        std::size_t steps = 0;
        for (const TimePoint end = Now + time; Now < end; Now += 1ms)
        {
            for (Serial node = 1; steps % 500 == 0 && node <= others; ++node)
            {
                Pace.Heard(node, Now);
            }
            ++steps;
            if (Pace.IsFree(Now))
            {
                EXPECT_LE(Pace.Free(), Now);
                Pace.Take(size - SharedPace::IpAndUdp);
                bytes += size;
            }
        }
        return static_cast<double>(bytes) / std::chrono::duration<double>(time).count();
    }

    TimePoint Now{1h};
    SharedPace Pace;
};

TEST_F(SharedPaces, GiveALoneSessionItsMost)
{
    EXPECT_NEAR(RateBeside(0), SharedPace::MostOfOne, 100.0);
}

TEST_F(SharedPaces, DivideTheWholeAmongThoseThatAreHeard)
{
    EXPECT_NEAR(RateBeside(1), SharedPace::AllTogether / 2, 100.0);
    EXPECT_NEAR(RateBeside(4), SharedPace::AllTogether / 5, 50.0);
}

TEST_F(SharedPaces, LeaveASessionItsLeastHoweverManyAreHeard)
{
    EXPECT_NEAR(RateBeside(300), SharedPace::LeastOfOne, 50.0);
}

TEST_F(SharedPaces, CountNobodyThatIsSilent)
{
    RateBeside(9);
    Now += SharedPace::Counts;
    EXPECT_NEAR(RateBeside(0), SharedPace::MostOfOne, 100.0);
}

TEST_F(SharedPaces, SaveUpLessWhereMoreAreHeard)
{
    for (Serial node = 1; node <= 9; ++node)
    {
        Pace.Heard(node, Now);
    }
    // 187 bytes are left, and one datagram may go below zero.
    ASSERT_TRUE(Pace.IsFree(Now));
    Pace.Take(472);
    EXPECT_FALSE(Pace.IsFree(Now));
    EXPECT_FALSE(Pace.IsFree(Pace.Free() - 1ms));
    EXPECT_TRUE(Pace.IsFree(Pace.Free()));
}

}  // namespace
