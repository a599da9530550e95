// The small parts that the rules are made of.
#include "Assembly.h"
#include "AssemblyMemory.h"
#include "OutcomeHistory.h"
#include "RingBuffer.h"
#include "RoundTrip.h"

#include <rabit/gateway/links/LinkOutcome.h>

#include <gtest/gtest.h>

#include <deque>
#include <memory>

namespace Rabit::Test
{
namespace
{

using namespace std::chrono_literals;

TEST(RingBuffer, BehavesAsADequeWhileItGrowsAndWraps)
{
    RingBuffer<int> ring;
    std::deque<int> model;
    unsigned random = 12345;
    for (int i = 0; i < 100000; ++i)
    {
        random = random * 1664525 + 1013904223;
        const unsigned choice = (random >> 16) % 8;
        if (choice < 4)
        {
            ring.PushBack(i);
            model.push_back(i);
        }
        else if (choice == 4)
        {
            ring.PushFront(i);
            model.push_front(i);
        }
        else if (!model.empty() && choice == 5)
        {
            ASSERT_EQ(ring.PopBack(), model.back());
            model.pop_back();
        }
        else if (!model.empty())
        {
            ASSERT_EQ(ring.PopFront(), model.front());
            model.pop_front();
        }
        ASSERT_EQ(ring.Size(), model.size());
        ASSERT_EQ(ring.Empty(), model.empty());
        if (!model.empty())
        {
            ASSERT_EQ(ring[(random >> 8) % model.size()], model[(random >> 8) % model.size()]);
        }
    }
}

TEST(RingBuffer, KeepsNothingOfWhatWasTakenOut)
{
    RingBuffer<std::shared_ptr<int>> ring;
    const auto value = std::make_shared<int>(1);
    ring.PushBack(value);
    ring.PushBack(value);
    ring.PopFront();
    ring.PopBack();
    EXPECT_EQ(value.use_count(), 1);
}

TEST(OutcomeHistory, RemembersTheLast1024AndNoMore)
{
    OutcomeHistory history;
    history.Set(1, OutcomeHistory::Entry::Refused);
    for (std::uint64_t i = 2; i <= 1024; ++i)
    {
        history.Set(i, i % 3 == 0 ? OutcomeHistory::Entry::Delivered : OutcomeHistory::Entry::Skipped);
    }
    EXPECT_TRUE(OutcomeHistory::Test(history.Refused(), 1));
    EXPECT_TRUE(OutcomeHistory::Test(history.Delivered(), 999));
    EXPECT_FALSE(OutcomeHistory::Test(history.Delivered(), 1000));
    history.Set(1025, OutcomeHistory::Entry::Delivered);
    EXPECT_TRUE(OutcomeHistory::Test(history.Delivered(), 1025));
    EXPECT_FALSE(OutcomeHistory::Test(history.Refused(), 1025)) << "nothing of what had that place";
    history.Clear();
    EXPECT_EQ(history.Delivered(), LinkBitmap{});
}

// The figures of RFC 6298, section 2, worked out by hand.
TEST(RoundTrip, FollowsRfc6298)
{
    RoundTrip times;
    EXPECT_FALSE(times.IsKnown());
    times.Measured(100ms);
    EXPECT_EQ(times.Smoothed(), 100ms);
    EXPECT_EQ(times.Variation(), 50ms) << "R/2";
    times.Measured(180ms);
    EXPECT_EQ(times.Smoothed(), 110ms) << "7/8 * 100 + 1/8 * 180";
    EXPECT_EQ(times.Variation(), 57500us) << "3/4 * 50 + 1/4 * 80";
    EXPECT_EQ(times.Latest(), 180ms);
}

TEST(AssemblyMemory, LetsOneGoBeyondTheLimitAndAnotherOneWhenThatStandsStill)
{
    AssemblyMemory memory(100);
    Assembly a(memory);
    Assembly b(memory);
    EXPECT_TRUE(memory.Take(a, 60, 0s));
    EXPECT_TRUE(memory.Take(b, 40, 0s));
    EXPECT_TRUE(memory.Take(a, 1, 0s));
    EXPECT_FALSE(memory.Take(b, 1, 0s));
    EXPECT_TRUE(memory.Take(a, 50, 9s));
    EXPECT_FALSE(memory.Take(b, 1, 18s)) << "a went on 9 s ago";
    EXPECT_TRUE(memory.Take(b, 1, 19s));
    EXPECT_FALSE(memory.Take(a, 1, 19s));
    memory.Give(b, 41);
    EXPECT_TRUE(memory.Take(a, 1, 19s));
    memory.Give(a, 112);
    EXPECT_EQ(memory.Used(), 0U);
}

TEST(LinkOutcome, HasWordsForLogs)
{
    EXPECT_EQ(ToString(LinkOutcome::InDoubt), "in doubt");
    EXPECT_EQ(ToString(LinkRefusal::FullByBytes), "outbox full by bytes");
}

}  // namespace
}  // namespace Rabit::Test
