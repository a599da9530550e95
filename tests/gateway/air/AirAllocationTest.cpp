// In the steady state the schedule and the estimate allocate nothing for a datagram. A program of its own,
// because it replaces operator new.
#include <gtest/gtest.h>

#include <vector>

#include "../../bench/common/Usage.h"
#include "air/AirSchedule.h"
#include "air/CapacityEstimate.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(AirAllocation, NothingIsAllocatedForADatagram)
{
    AirSchedule schedule(1428);
    CapacityEstimate estimate;
    std::vector<StreamId> streams;
    for (std::size_t i = 0; i < 100; ++i)
    {
        streams.push_back(schedule.AddStream(static_cast<TrafficClass>(i % TrafficClassCount)));
    }
    std::chrono::nanoseconds now{0};
    std::size_t sent = 0;
    const auto turn = [&]
    {
        for (const StreamId id : streams)
        {
            schedule.Ready(id, 200);
        }
        for (const auto end = now + 100ms; now < end; now += 1ms)
        {
            while (const auto next = schedule.Next(now))
            {
                schedule.Sent(*next, 200, now);
                estimate.Sent(200, now);
                ++sent;
            }
        }
        schedule.NotReady(streams[0]);
    };
    turn();
    const std::uint64_t before = Bench::AllocationsSoFar();
    for (int i = 0; i < 300; ++i)
    {
        if (i == 100)
        {
            schedule.SetBudget(50'000, now);
        }
        if (i == 200)
        {
            schedule.SetPace(50'000, now);
        }
        turn();
    }
    EXPECT_EQ(Bench::AllocationsSoFar(), before);
    EXPECT_GT(sent, 14'000u);
}

}  // namespace
}  // namespace Rabit
