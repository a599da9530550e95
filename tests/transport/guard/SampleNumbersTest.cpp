// The numbers of a best-effort writer, one of which was forged.
#include "guard/SampleNumbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace
{

using namespace std::chrono_literals;
using Rabit::Rtps::SampleNumbers;

constexpr std::uint64_t Second = std::uint64_t{1} << 32;

class SampleNumbersTest : public testing::Test
{
protected:
    // A sample one second after the last one.
    std::int64_t Later(std::int64_t number)
    {
        Stamp += Second;
        Now += 1s;
        return At(number, Stamp);
    }
    std::int64_t At(std::int64_t number, std::uint64_t stamp) { return Numbers.Of(number, stamp, Now); }
    // Gives 1 to `last`, then a forged number: the last sample again, under the number `forged`.
    void Forge(std::int64_t last, std::int64_t forged)
    {
        for (std::int64_t number = 1; number <= last; ++number)
        {
            EXPECT_EQ(Later(number), number);
        }
        EXPECT_EQ(At(forged, Stamp), forged);
    }

    SampleNumbers Numbers;
    std::uint64_t Stamp = 1'700'000'000 * Second;
    SampleNumbers::TimePoint Now{1h};
};

TEST_F(SampleNumbersTest, NumbersThatRiseRemainAsTheyAre)
{
    for (const std::int64_t number : {5, 6, 7, 20, 21, 1'000'000})
    {
        EXPECT_EQ(Later(number), number);
    }
}

TEST_F(SampleNumbersTest, WhoGoesOnBelowAForgedNumberIsHeardFromTheThirdSampleOn)
{
    Forge(10, 26);
    EXPECT_EQ(Later(11), 11);
    EXPECT_EQ(Later(12), 12);
    EXPECT_EQ(Later(13), 27);
    EXPECT_EQ(Later(14), 28);
    EXPECT_EQ(Later(40), 54);
}

TEST_F(SampleNumbersTest, AFirstNumberThatWasForgedFarAheadSilencesNobody)
{
    EXPECT_EQ(At(4'000'000, Stamp), 4'000'000);
    Later(1);
    Later(2);
    EXPECT_EQ(Later(3), 4'000'001);
}

TEST_F(SampleNumbersTest, OneForgedNumberAfterTheOtherIsGotOver)
{
    Forge(10, 26);
    std::int64_t given = 26;
    for (std::int64_t number = 11; number < 300; number += 10)
    {
        for (std::int64_t sample = number; sample < number + 10; ++sample)
        {
            const std::int64_t now = Later(sample);
            EXPECT_EQ(now > given, sample - number >= 2) << sample;
            given = std::max(given, now);
        }
        given = At(number + 9 + 16, Stamp);
    }
}

TEST_F(SampleNumbersTest, WhatIsOvertakenStaysBelow)
{
    Later(1);
    const std::uint64_t written = Stamp;
    Later(6);
    for (std::int64_t late = 2; late <= 5; ++late)
    {
        EXPECT_EQ(At(late, written + static_cast<std::uint64_t>(late)), late);
    }
    EXPECT_EQ(Later(7), 7);
}

TEST_F(SampleNumbersTest, OldSamplesOnceMoreStayBelow)
{
    const std::uint64_t began = Stamp;
    Forge(30, 46);
    for (std::int64_t number = 1; number <= 30; ++number)
    {
        EXPECT_EQ(At(number, began + static_cast<std::uint64_t>(number) * Second), number);
    }
}

TEST_F(SampleNumbersTest, FragmentsOfASampleCountOnce)
{
    Forge(10, 26);
    Later(11);
    for (int fragment = 0; fragment < 10; ++fragment)
    {
        EXPECT_EQ(At(11, Stamp), 11);
    }
    EXPECT_EQ(Later(12), 12);
    EXPECT_EQ(Later(13), 27);
    EXPECT_EQ(At(13, Stamp), 27) << "its next fragment";
}

TEST_F(SampleNumbersTest, OneFromAboveInBetweenBeginsAnew)
{
    Forge(10, 26);
    const std::uint64_t written = Stamp;
    Later(11);
    Later(12);
    EXPECT_EQ(At(26, written), 26) << "the same once more";
    EXPECT_EQ(Later(13), 13);
    EXPECT_EQ(Later(14), 14);
    EXPECT_EQ(Later(15), 27);
}

TEST_F(SampleNumbersTest, WithoutATimeNumbersRemainAsTheyAre)
{
    for (const std::int64_t number : {10, 26, 11, 12, 13, 14})
    {
        EXPECT_EQ(At(number, 0), number);
    }
}

TEST_F(SampleNumbersTest, AForgedTimeFarAheadDoesNotKeepAWriterSilent)
{
    Forge(10, 11);
    EXPECT_EQ(At(26, Stamp + 100'000 * Second), 26);
    for (std::int64_t number = 12; number < 16; ++number)
    {
        EXPECT_EQ(Later(number), number);
    }
    EXPECT_EQ(Later(16), 27);
}

TEST_F(SampleNumbersTest, SamplesThatAreWrittenTogetherCountOnce)
{
    Forge(10, 26);
    for (const std::int64_t number : {11, 13})
    {
        EXPECT_EQ(Later(number), number);
        EXPECT_EQ(At(number + 1, Stamp), number + 1);
    }
    EXPECT_EQ(Later(15), 27);
    EXPECT_EQ(At(16, Stamp), 28);
}

// The clock is set while the writer is below the forged number.
TEST_F(SampleNumbersTest, AWriterWhoseClockIsSetForwardIsFollowed)
{
    Forge(10, 26);
    Stamp += 3600 * Second;
    Later(11);
    Later(12);
    EXPECT_EQ(Later(13), 27);
}

TEST_F(SampleNumbersTest, AWriterWhoseClockWasSetBackIsHeardAgainWhenItsTimesHaveRisenForAWhile)
{
    Forge(10, 11);
    Stamp -= 3600 * Second;
    Later(12);
    Later(13);
    EXPECT_EQ(At(30, Stamp), 30);
    for (std::int64_t number = 14; number < 18; ++number)
    {
        EXPECT_EQ(Later(number), number);
    }
    EXPECT_EQ(Later(18), 31);
}

TEST_F(SampleNumbersTest, OldSamplesOnceMoreRightAfterAClockWasSetStayBelow)
{
    for (const int seconds : {-3600, -5, 3600})
    {
        Numbers = {};
        std::vector<std::uint64_t> stamps;
        for (std::int64_t number = 1; number <= 10; ++number)
        {
            Later(number);
            stamps.push_back(Stamp);
        }
        Stamp += static_cast<std::uint64_t>(seconds) * Second;
        EXPECT_EQ(Later(11), 11);
        for (std::int64_t number = 6; number <= 10; ++number)
        {
            EXPECT_EQ(At(number, stamps[static_cast<std::size_t>(number) - 1]), number) << seconds;
        }
        EXPECT_EQ(Later(12), 12);
    }
}

// A timestamp that is an hour later is no reason for doubt if the hour has passed.
TEST_F(SampleNumbersTest, OldSamplesOfASlowWriterStayBelow)
{
    std::vector<std::uint64_t> stamps;
    for (std::int64_t number = 1; number <= 10; ++number)
    {
        Stamp += 3600 * Second;
        Now += 1h;
        EXPECT_EQ(At(number, Stamp), number);
        stamps.push_back(Stamp);
    }
    Now += 1min;
    for (std::int64_t number = 1; number <= 10; ++number)
    {
        EXPECT_EQ(At(number, stamps[static_cast<std::size_t>(number) - 1]), number);
    }
}

// For any input, no sample is delivered as new a second time.
TEST_F(SampleNumbersTest, NothingIsHandedOnAsNewTwice)
{
    std::mt19937 chance(1);
    for (int run = 0; run < 200; ++run)
    {
        Numbers = {};
        std::vector<std::pair<std::int64_t, std::uint64_t>> written;
        std::set<std::uint64_t> taken;
        std::int64_t highest = 0;
        const auto give = [&](std::int64_t number, std::uint64_t stamp, bool honest)
        {
            const std::int64_t given = At(number, stamp);
            if (given > highest)
            {
                highest = given;
                EXPECT_TRUE(!honest || taken.insert(stamp).second) << "run " << run;
            }
        };
        for (std::int64_t number = 1; number < 300; ++number)
        {
            Stamp += Second / 10;
            if (chance() % 100 == 0)
            {
                Stamp = Stamp + (chance() % 1000) * Second - 500 * Second;
            }
            Now += 100ms;
            written.emplace_back(number, Stamp);
            give(number, Stamp, true);
            if (chance() % 10 == 0)
            {
                give(number + 1 + static_cast<std::int64_t>(chance() % 16), Stamp, false);
            }
            // The last samples come once more, in their order.
            const std::size_t again = chance() % 5;
            for (std::size_t i = written.size() - std::min(again, written.size()); i < written.size(); ++i)
            {
                give(written[i].first, written[i].second, true);
            }
        }
    }
}

}  // namespace
