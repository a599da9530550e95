// Which numbers of a sender were taken.
#include "envelope/ReplayWindow.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <set>

namespace
{

using Rabit::Envelope::ReplayWindow;
using Verdict = ReplayWindow::Verdict;

constexpr std::uint64_t TwoTo32 = std::uint64_t{1} << 32;

TEST(EnvelopeReplayWindow, TakesEachNumberOnce)
{
    ReplayWindow window;
    for (const std::uint64_t number : {0ull, 1ull, 63ull, 64ull, 65ull, 4095ull, 4096ull, 10'000ull})
    {
        EXPECT_EQ(window.Look(number), Verdict::New) << number;
        window.Mark(number);
        EXPECT_EQ(window.Look(number), Verdict::Seen) << number;
    }
}

TEST(EnvelopeReplayWindow, LookingMarksNothing)
{
    ReplayWindow window;
    window.Mark(5);
    EXPECT_EQ(window.Look(9'000'000), Verdict::New);
    EXPECT_EQ(window.Highest(), 5u);
    EXPECT_EQ(window.Look(9'000'000), Verdict::New);
    EXPECT_EQ(window.Look(0), Verdict::New);
}

TEST(EnvelopeReplayWindow, Reaches4095NumbersBack)
{
    ReplayWindow window;
    window.Mark(100'000);
    EXPECT_EQ(window.Look(100'000 - 4095), Verdict::New);
    EXPECT_EQ(window.Look(100'000 - 4096), Verdict::TooOld);
    window.Mark(100'000 - 4095);
    EXPECT_EQ(window.Look(100'000 - 4095), Verdict::Seen);
    window.Mark(100'001);
    EXPECT_EQ(window.Look(100'000 - 4095), Verdict::TooOld);
}

TEST(EnvelopeReplayWindow, KnowsNothingOfNumbersThatItJumpedOver)
{
    for (const std::uint64_t jump :
         {1ull, 63ull, 64ull, 65ull, 4095ull, 4096ull, 4160ull, 4161ull, 1ull << 40})
    {
        ReplayWindow window;
        for (std::uint64_t number = 0; number < 5000; ++number)
        {
            window.Mark(number);
        }
        const std::uint64_t to = 4999 + jump;
        window.Mark(to);
        for (std::uint64_t back = 0; back < ReplayWindow::Size && back <= to; ++back)
        {
            const std::uint64_t number = to - back;
            EXPECT_EQ(window.Look(number), number < 5000 || back == 0 ? Verdict::Seen : Verdict::New)
                << jump << ", " << number;
        }
    }
}

TEST(EnvelopeReplayWindow, AgreesWithASetOfAllNumbers)
{
    std::mt19937_64 random(1);
    ReplayWindow window;
    std::set<std::uint64_t> taken;
    std::uint64_t highest = 0;
    for (int i = 0; i < 50'000; ++i)
    {
        const std::uint64_t number = highest + 40 - std::min<std::uint64_t>(random() % 5000, highest + 40);
        const Verdict expected = !taken.empty() && number + ReplayWindow::Size <= highest ? Verdict::TooOld
                                 : taken.contains(number)                                 ? Verdict::Seen
                                                                                          : Verdict::New;
        ASSERT_EQ(window.Look(number), expected) << number << " of " << highest;
        if (expected == Verdict::New)
        {
            window.Mark(number);
            taken.insert(number);
            highest = std::max(highest, number);
        }
    }
}

TEST(EnvelopeReplayWindow, RestoresANumberFromItsLowHalf)
{
    ReplayWindow window;
    EXPECT_EQ(window.Restore(7), 7u);
    window.Mark(TwoTo32 - 3);
    EXPECT_EQ(window.Restore(0xfffffffe), TwoTo32 - 2);
    EXPECT_EQ(window.Restore(2), TwoTo32 + 2);
    window.Mark(TwoTo32 + 2);
    EXPECT_EQ(window.Restore(0xffffffff), TwoTo32 - 1);
    EXPECT_EQ(window.Restore(3), TwoTo32 + 3);
    window.Mark(5 * TwoTo32 + 100);
    EXPECT_EQ(window.Restore(99), 5 * TwoTo32 + 99);
    EXPECT_EQ(window.Restore(0xffffff00), 4 * TwoTo32 + 0xffffff00);
}

TEST(EnvelopeReplayWindow, RestoresNoNumberBeyondTheLast)
{
    ReplayWindow window;
    window.Mark(std::numeric_limits<std::uint64_t>::max() - 1);
    EXPECT_EQ(window.Restore(2), std::numeric_limits<std::uint64_t>::max() - 0xffffffff + 2);
    EXPECT_EQ(window.Look(window.Restore(2)), Verdict::TooOld);
}

TEST(EnvelopeReplayWindow, RefusesWhatIsBelowTheFloor)
{
    ReplayWindow window;
    window.Mark(10);
    window.SetFloor(20);
    EXPECT_EQ(window.Look(19), Verdict::TooOld);
    EXPECT_EQ(window.Look(20), Verdict::New);
    window.SetFloor(5);
    EXPECT_EQ(window.Look(19), Verdict::TooOld);
}

}  // namespace
