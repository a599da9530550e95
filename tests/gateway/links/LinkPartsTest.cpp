// The small parts that the rules are made of.
#include "ByteWindow.h"
#include "OutcomeHistory.h"
#include "ResendTimer.h"
#include "RingBuffer.h"

#include <rabit/gateway/links/LinkOutcome.h>

#include <gtest/gtest.h>

#include <deque>
#include <memory>

namespace Rabit::Test
{
namespace
{

using namespace std::chrono_literals;

TEST(RingBuffer, behaves_as_a_deque_while_it_grows_and_wraps)
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

TEST(RingBuffer, keeps_nothing_of_what_was_taken_out)
{
    RingBuffer<std::shared_ptr<int>> ring;
    const auto value = std::make_shared<int>(1);
    ring.PushBack(value);
    ring.PushBack(value);
    ring.PopFront();
    ring.PopBack();
    EXPECT_EQ(value.use_count(), 1);
}

TEST(OutcomeHistory, remembers_the_last_256_and_no_more)
{
    OutcomeHistory history;
    history.Push(OutcomeHistory::Entry::Refused);
    for (int i = 0; i < 254; ++i)
    {
        history.Push(i % 3 == 0 ? OutcomeHistory::Entry::Delivered : OutcomeHistory::Entry::Skipped);
    }
    EXPECT_TRUE(OutcomeHistory::Test(history.Refused(), 254));
    EXPECT_TRUE(OutcomeHistory::Test(history.Delivered(), 253));
    EXPECT_FALSE(OutcomeHistory::Test(history.Delivered(), 252));
    EXPECT_TRUE(OutcomeHistory::Test(history.Delivered(), 253 - 64 * 3));
    history.Push(OutcomeHistory::Entry::Delivered);
    EXPECT_TRUE(OutcomeHistory::Test(history.Refused(), 255));
    history.Push(OutcomeHistory::Entry::Delivered);
    EXPECT_FALSE(OutcomeHistory::Test(history.Refused(), 255));
    EXPECT_FALSE(OutcomeHistory::Test(history.Refused(), 256));
    history.Clear();
    EXPECT_EQ(history.Delivered(), LinkBitmap{});
}

// The figures of RFC 6298, section 2, worked out by hand.
TEST(ResendTimer, follows_rfc_6298)
{
    ResendTimer timer{LinkSettings()};
    EXPECT_EQ(timer.Timeout(), 200ms) << "before the first measurement";
    timer.Measured(100ms);
    EXPECT_EQ(timer.RoundTrip(), 100ms);
    EXPECT_EQ(timer.Timeout(), 300ms) << "SRTT + 4 * R/2";
    timer.Measured(180ms);
    EXPECT_EQ(timer.RoundTrip(), 110ms) << "7/8 * 100 + 1/8 * 180";
    EXPECT_EQ(timer.Timeout(), 110ms + 4 * 57500us) << "RTTVAR = 3/4 * 50 + 1/4 * 80";
}

TEST(ResendTimer, doubles_up_to_the_bound_and_is_restored)
{
    ResendTimer timer{LinkSettings()};
    timer.Measured(50ms);
    for (const LinkTime expected : {150ms, 300ms, 600ms, 1000ms, 1000ms})
    {
        EXPECT_EQ(timer.Timeout(), expected);
        timer.BackOff();
    }
    EXPECT_EQ(timer.PlainTimeout(), 150ms);
    timer.Restore();
    EXPECT_EQ(timer.Timeout(), 150ms);
    timer.BackOff();
    timer.Measured(50ms);
    EXPECT_EQ(timer.Timeout(), 50ms + 4 * 18750us) << "a measurement ends the back-off";
}

TEST(ResendTimer, stays_within_its_bounds)
{
    ResendTimer fast{LinkSettings()};
    for (int i = 0; i < 100; ++i)
    {
        fast.Measured(100us);
    }
    EXPECT_EQ(fast.Timeout(), 20ms);
    ResendTimer slow{LinkSettings()};
    slow.Measured(30s);
    EXPECT_EQ(slow.Timeout(), 1s);
    for (int i = 0; i < 1000; ++i)
    {
        slow.BackOff();
    }
    EXPECT_EQ(slow.Timeout(), 1s);
    ResendTimer zero{LinkSettings()};
    zero.Measured(0ns);
    EXPECT_EQ(zero.Timeout(), 20ms);
}

LinkOptions Windows(std::size_t smallest, std::size_t largest)
{
    LinkOptions options;
    options.WindowBytes = smallest;
    options.LargestWindowBytes = largest;
    return options;
}

TEST(ByteWindow, doubles_with_each_short_round_trip_that_fills_it_up_to_the_largest)
{
    ByteWindow window(Windows(100, 350), 10ms);
    for (const std::size_t expected : {200U, 350U, 350U})
    {
        const std::size_t inFlight = window.Bytes();
        window.Measured(10ms);
        window.Acknowledged(inFlight, inFlight);
        EXPECT_EQ(window.Bytes(), expected);
    }
    EXPECT_TRUE(window.Fits(300, 50));
    EXPECT_FALSE(window.Fits(300, 51));
}

TEST(ByteWindow, does_not_grow_before_a_round_trip_was_measured)
{
    ByteWindow window(Windows(100, 1000), 10ms);
    window.Acknowledged(100, 100);
    EXPECT_EQ(window.Bytes(), 100U);
}

TEST(ByteWindow, does_not_grow_while_less_than_half_of_it_is_used)
{
    ByteWindow window(Windows(100, 1000), 10ms);
    window.Measured(1ms);
    window.Acknowledged(49, 49);
    EXPECT_EQ(window.Bytes(), 100U);
}

TEST(ByteWindow, is_as_at_the_beginning_after_a_long_round_trip)
{
    ByteWindow window(Windows(100, 1000), 10ms);
    window.Measured(1ms);
    window.Acknowledged(100, 100);
    window.Measured(10ms + 1ns);
    EXPECT_EQ(window.Bytes(), 100U);
    window.Acknowledged(100, 100);
    EXPECT_EQ(window.Bytes(), 100U);
}

TEST(ByteWindow, is_never_smaller_than_the_smallest)
{
    ByteWindow window(Windows(100, 0), 10ms);
    window.Measured(1ms);
    window.Acknowledged(100, 100);
    EXPECT_EQ(window.Bytes(), 100U);
}

TEST(LinkOutcome, has_words_for_logs)
{
    EXPECT_EQ(ToString(LinkOutcome::InDoubt), "in doubt");
    EXPECT_EQ(ToString(LinkRefusal::FullByBytes), "outbox full by bytes");
}

}  // namespace
}  // namespace Rabit::Test
