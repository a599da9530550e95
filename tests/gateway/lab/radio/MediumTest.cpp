#include "Medium.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace Rabit::Radio
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

MacAddress AddressOf(std::size_t node)
{
    return {2, 0, 0, 0, 0, static_cast<std::uint8_t>(node)};
}

FramePointer FrameTo(const MacAddress &to, std::size_t bytes)
{
    Frame frame(bytes, 0x55);
    std::copy(to.begin(), to.end(), frame.begin());
    return std::make_shared<const Frame>(std::move(frame));
}

FramePointer Unicast(std::size_t to, std::size_t bytes)
{
    return FrameTo(AddressOf(to), bytes);
}

FramePointer Multicast(std::size_t bytes)
{
    return FrameTo({1, 0, 0x5e, 1, 2, 3}, bytes);
}

class MediumTest : public testing::Test
{
protected:
    void Make(std::size_t nodes, std::optional<std::int64_t> rate, std::size_t queue = 16'000,
              std::size_t overhead = 0)
    {
        medium = std::make_unique<Medium>(MediumSettings{rate, queue, overhead, 7});
        for (std::size_t node = 0; node < nodes; ++node)
        {
            medium->Add(std::string("n").append(std::to_string(node)), AddressOf(node));
        }
    }

    std::vector<Arrival> Until(Time now)
    {
        std::vector<Arrival> arrived;
        medium->Advance(now, arrived);
        return arrived;
    }

    std::vector<std::pair<Time, std::size_t>> ArrivalsUntil(Time now)
    {
        std::vector<std::pair<Time, std::size_t>> found;
        for (const Arrival &arrival : Until(now))
        {
            found.emplace_back(arrival.At, arrival.To);
        }
        return found;
    }

    void Change(std::size_t from, std::size_t to, double loss, Time delay = 0ms, Time jitter = 0ms,
                bool deaf = false)
    {
        medium->SetLink(0s, from, to, {loss, delay, jitter, deaf});
    }

    std::unique_ptr<Medium> medium;
};

using Arrivals = std::vector<std::pair<Time, std::size_t>>;

TEST_F(MediumTest, AFrameIsOnTheAirForItsBytesByTheRate)
{
    Make(2, 1'000'000);
    medium->Offer(5ms, 0, Unicast(1, 1000));
    EXPECT_EQ(medium->NextEvent(), 13ms);
    EXPECT_THAT(Until(13ms - 1ns), IsEmpty());
    EXPECT_EQ(ArrivalsUntil(13ms), (Arrivals{{13ms, 1}}));
    EXPECT_EQ(medium->NextEvent(), std::nullopt);
}

TEST_F(MediumTest, EachFrameTakesTheOverheadToo)
{
    Make(2, 1'000'000, 16'000, 250);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{10ms, 1}}));
    EXPECT_EQ(medium->CountersOf(0).Unicast.Bytes, 1250u);
}

TEST_F(MediumTest, FramesFollowEachOtherWithoutAPauseHoweverLateTheCallerIs)
{
    Make(2, 1'000'000);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->Offer(1ms, 0, Unicast(1, 500));
    medium->Offer(1ms, 0, Unicast(1, 500));
    EXPECT_EQ(ArrivalsUntil(10s), (Arrivals{{8ms, 1}, {12ms, 1}, {16ms, 1}}));
    EXPECT_EQ(medium->Busy(10s), 16ms);
}

TEST_F(MediumTest, OnlyOneFrameIsOnTheAirAtATime)
{
    Make(3, 1'000'000);
    medium->Offer(0ms, 0, Unicast(2, 1000));
    medium->Offer(1ms, 1, Unicast(2, 1000));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{8ms, 2}, {16ms, 2}}));
}

TEST_F(MediumTest, NodesTakeTurnsHoweverMuchOneHasToSend)
{
    Make(3, 8'000'000);
    for (int k = 0; k < 4; ++k)
    {
        medium->Offer(0ms, 0, Unicast(2, 1000));
    }
    medium->Offer(0ms, 1, Unicast(2, 100));
    medium->Offer(0ms, 1, Unicast(2, 100));
    std::vector<std::size_t> sizes;
    for (const Arrival &arrival : Until(1s))
    {
        sizes.push_back(arrival.What->size());
    }
    EXPECT_THAT(sizes, ElementsAre(1000, 100, 1000, 100, 1000, 1000));
}

TEST_F(MediumTest, AnUnlimitedMediumTakesNoTime)
{
    Make(2, std::nullopt);
    medium->Offer(3ms, 0, Unicast(1, 1500));
    medium->Offer(3ms, 0, Unicast(1, 1500));
    EXPECT_EQ(ArrivalsUntil(3ms), (Arrivals{{3ms, 1}, {3ms, 1}}));
    EXPECT_EQ(medium->Busy(1s), 0ms);
}

TEST_F(MediumTest, AFullQueueDropsWhatComesLast)
{
    Make(2, 8'000, 2'000);
    for (int k = 0; k < 4; ++k)
    {
        // The first frame is on the air, two wait, and the fourth does not fit.
        medium->Offer(0ms, 0, Unicast(1, 1000 - static_cast<std::size_t>(k)));
    }
    EXPECT_EQ(medium->CountersOf(0).Dropped.Frames, 1u);
    EXPECT_EQ(medium->CountersOf(0).Dropped.Bytes, 997u);
    EXPECT_EQ(medium->CountersOf(0).Offered.Frames, 4u);
    EXPECT_EQ(medium->QueuedBytes(0), 1997u);
    EXPECT_EQ(Until(10s).size(), 3u);
}

TEST_F(MediumTest, AQueueSmallerThanAFrameStillPassesOneAtATime)
{
    Make(2, 8'000, 100);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->Offer(0ms, 0, Unicast(1, 10));
    EXPECT_EQ(medium->CountersOf(0).Dropped.Frames, 1u);
    EXPECT_EQ(Until(10s).size(), 2u);
}

TEST_F(MediumTest, AQueueMadeSmallerKeepsWhatWaits)
{
    Make(2, 8'000, 3'000);
    for (int k = 0; k < 3; ++k)
    {
        medium->Offer(0ms, 0, Unicast(1, 1000));
    }
    medium->SetQueue(0, 1'000);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    EXPECT_EQ(medium->CountersOf(0).Dropped.Frames, 1u);
    EXPECT_EQ(Until(10s).size(), 3u);
}

TEST_F(MediumTest, WaitingIsMeasuredFromTheQueueToTheAir)
{
    Make(2, 8'000);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->Offer(300ms, 0, Unicast(1, 1000));
    EXPECT_EQ(medium->QueueAge(900ms, 0), 600ms);
    Until(10s);
    EXPECT_EQ(medium->CountersOf(0).LongestWait, 700ms);
    EXPECT_EQ(medium->QueueAge(10s, 0), 0ms);
}

TEST_F(MediumTest, MulticastCostsOnceAndReachesAllOthers)
{
    Make(4, 1'000'000);
    medium->Offer(0ms, 1, Multicast(1000));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{8ms, 0}, {8ms, 2}, {8ms, 3}}));
    EXPECT_EQ(medium->Busy(1s), 8ms);
    EXPECT_EQ(medium->CountersOf(1).Multicast.Frames, 1u);
    EXPECT_EQ(medium->CountersOf(1).Unicast.Frames, 0u);
}

TEST_F(MediumTest, BroadcastIsMulticast)
{
    Make(3, 1'000'000);
    medium->Offer(0ms, 0, FrameTo({255, 255, 255, 255, 255, 255}, 1000));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{8ms, 1}, {8ms, 2}}));
}

TEST_F(MediumTest, UnicastReachesItsAddressAlone)
{
    Make(3, 1'000'000);
    medium->Offer(0ms, 0, Unicast(2, 1000));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{8ms, 2}}));
    EXPECT_EQ(medium->CountersOf(2).Heard.Bytes, 1000u);
}

TEST_F(MediumTest, UnicastToNobodyCostsAirAndIsCounted)
{
    Make(2, 1'000'000);
    medium->Offer(0ms, 0, Unicast(9, 1000));
    EXPECT_THAT(Until(1s), IsEmpty());
    EXPECT_EQ(medium->Busy(1s), 8ms);
    EXPECT_EQ(medium->CountersOf(0).Nobody, 1u);
    medium->Offer(1s, 0, Unicast(0, 1000));
    EXPECT_THAT(Until(2s), IsEmpty());
    EXPECT_EQ(medium->CountersOf(0).Nobody, 2u);
}

TEST_F(MediumTest, FramesWithoutAHeaderReachNobody)
{
    Make(2, 1'000'000);
    medium->Offer(0ms, 0, std::make_shared<const Frame>(Frame(3, 0xff)));
    medium->Offer(0ms, 0, std::make_shared<const Frame>());
    EXPECT_THAT(Until(1s), IsEmpty());
    EXPECT_EQ(medium->CountersOf(0).Nobody, 2u);
}

TEST_F(MediumTest, LossIsIndependentForEachReceiver)
{
    Make(3, std::nullopt);
    Change(0, 1, 0.2);
    Change(0, 2, 0.5);
    constexpr int Frames = 20'000;
    int both = 0;
    for (int k = 0; k < Frames; ++k)
    {
        const std::uint64_t before = medium->CountersOf(1).Lost + medium->CountersOf(2).Lost;
        medium->Offer(Time(k), 0, Multicast(100));
        both += medium->CountersOf(1).Lost + medium->CountersOf(2).Lost - before == 2;
    }
    // Four standard deviations of the binomial distributions.
    EXPECT_NEAR(static_cast<double>(medium->CountersOf(1).Lost), 0.2 * Frames, 227);
    EXPECT_NEAR(static_cast<double>(medium->CountersOf(2).Lost), 0.5 * Frames, 283);
    EXPECT_NEAR(both, 0.1 * Frames, 170);
    EXPECT_EQ(medium->CountersOf(0).Multicast.Frames, static_cast<std::uint64_t>(Frames));
}

TEST_F(MediumTest, LossOfOneWayLeavesTheOther)
{
    Make(2, std::nullopt);
    Change(0, 1, 1);
    medium->Offer(0ms, 0, Unicast(1, 100));
    medium->Offer(0ms, 1, Unicast(0, 100));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{0ms, 0}}));
    EXPECT_EQ(medium->CountersOf(1).Lost, 1u);
}

TEST_F(MediumTest, ADuplicateComesTwiceAndIsOnTheAirOnce)
{
    Make(2, std::nullopt);
    LinkSettings settings;
    settings.Duplicate = 1;
    medium->SetLink(0s, 0, 1, settings);
    medium->Offer(0ms, 0, Unicast(1, 100));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{0ms, 1}, {0ms, 1}}));
    EXPECT_EQ(medium->CountersOf(0).Unicast.Frames, 1u);
}

TEST_F(MediumTest, DuplicatesAreAShareOfTheFramesHeard)
{
    Make(2, std::nullopt);
    LinkSettings settings;
    settings.Duplicate = 0.05;
    settings.Loss = 0.5;
    medium->SetLink(0s, 0, 1, settings);
    constexpr int Frames = 20'000;
    for (int k = 0; k < Frames; ++k)
    {
        medium->Offer(Time(k), 0, Unicast(1, 100));
    }
    const auto heard = static_cast<std::size_t>(Frames) - medium->CountersOf(1).Lost;
    // Four standard deviations of the binomial distribution.
    EXPECT_NEAR(static_cast<double>(ArrivalsUntil(1s).size() - heard), 500, 90);
}

TEST_F(MediumTest, TheSameSeedLosesTheSame)
{
    std::vector<std::uint64_t> lost;
    for (int run = 0; run < 2; ++run)
    {
        Make(2, std::nullopt);
        Change(0, 1, 0.3);
        std::uint64_t digest = 0;
        for (int k = 0; k < 64; ++k)
        {
            medium->Offer(Time(k), 0, Unicast(1, 100));
            digest = digest * 2 + medium->CountersOf(1).Lost % 2;
        }
        lost.push_back(digest);
    }
    EXPECT_EQ(lost[0], lost[1]);
    EXPECT_NE(lost[0], 0u);
}

TEST_F(MediumTest, WhoIsDeafToOneHearsOthersAndIsHeard)
{
    Make(3, std::nullopt);
    Change(0, 1, 0, 0ms, 0ms, true);
    medium->Offer(0ms, 0, Multicast(100));
    EXPECT_EQ(ArrivalsUntil(0ms), (Arrivals{{0ms, 2}}));
    medium->Offer(1ms, 1, Multicast(100));
    EXPECT_EQ(ArrivalsUntil(1ms), (Arrivals{{1ms, 0}, {1ms, 2}}));
    medium->Offer(2ms, 2, Multicast(100));
    EXPECT_EQ(ArrivalsUntil(2ms), (Arrivals{{2ms, 0}, {2ms, 1}}));
    EXPECT_EQ(medium->CountersOf(1).Missed, 1u);
    EXPECT_EQ(medium->CountersOf(1).Lost, 0u);
}

TEST_F(MediumTest, DelayComesAfterTheAirAndDoesNotOccupyIt)
{
    Make(2, 1'000'000);
    Change(0, 1, 0, 300ms);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->Offer(0ms, 0, Unicast(1, 1000));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{308ms, 1}, {316ms, 1}}));
    EXPECT_EQ(medium->Busy(1s), 16ms);
}

TEST_F(MediumTest, JitterSpreadsAroundTheDelayAndKeepsTheOrder)
{
    Make(2, std::nullopt);
    Change(0, 1, 0, 100ms, 20ms);
    for (int k = 0; k < 1000; ++k)
    {
        medium->Offer(k * 1ms, 0, Unicast(1, 100 + static_cast<std::size_t>(k)));
    }
    const std::vector<Arrival> arrived = Until(10s);
    ASSERT_EQ(arrived.size(), 1000u);
    Time least = 1s;
    Time most = 0s;
    for (int k = 0; k < 1000; ++k)
    {
        const Arrival &arrival = arrived[static_cast<std::size_t>(k)];
        ASSERT_EQ(arrival.What->size(), 100u + static_cast<std::size_t>(k));
        least = std::min(least, arrival.At - k * 1ms);
        most = std::max(most, arrival.At - k * 1ms);
    }
    EXPECT_GE(least, 80ms);
    EXPECT_LE(most, 120ms);
    EXPECT_GT(most, 118ms);
}

TEST_F(MediumTest, JitterReordersIfAsked)
{
    Make(2, std::nullopt);
    Change(0, 1, 0, 100ms, 20ms);
    medium->SetReordering(true);
    for (std::size_t k = 0; k < 100; ++k)
    {
        medium->Offer(k * 1ms, 0, Unicast(1, 100 + k));
    }
    const std::vector<Arrival> arrived = Until(10s);
    ASSERT_EQ(arrived.size(), 100u);
    EXPECT_FALSE(std::is_sorted(arrived.begin(), arrived.end(),
                                [](const Arrival &a, const Arrival &b)
                                { return a.What->size() < b.What->size(); }));
}

TEST_F(MediumTest, JitterAboveTheDelayNeverArrivesBeforeTheAirEnds)
{
    Make(2, 1'000'000);
    Change(0, 1, 0, 0ms, 20ms);
    for (int k = 0; k < 10; ++k)
    {
        medium->Offer(0ms, 0, Unicast(1, 1000));
    }
    Time ends = 0ms;
    for (const Arrival &arrival : Until(10s))
    {
        ends += 8ms;
        EXPECT_GE(arrival.At, ends);
    }
    EXPECT_EQ(ends, 80ms);
}

TEST_F(MediumTest, AChangeOfRateHoldsForWhatIsLeftOfTheFrame)
{
    Make(2, 1'000'000);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->SetRate(4ms, 100'000);
    EXPECT_EQ(medium->NextEvent(), 44ms);
    medium->SetRate(24ms, 2'000'000);
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{25ms, 1}}));
}

TEST_F(MediumTest, AMediumThatBecomesUnlimitedEndsTheFrameAtOnceAndEmptiesTheQueues)
{
    Make(2, 1'000);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->SetRate(5ms, std::nullopt);
    EXPECT_EQ(ArrivalsUntil(5ms), (Arrivals{{5ms, 1}, {5ms, 1}}));
    medium->SetRate(6ms, 8'000'000);
    medium->Offer(6ms, 0, Unicast(1, 1000));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{7ms, 1}}));
}

TEST_F(MediumTest, RatesThatAreNoneAreRefused)
{
    EXPECT_THROW(Make(2, 0), std::invalid_argument);
    Make(2, 1'000);
    EXPECT_THROW(medium->SetRate(0ms, -5), std::invalid_argument);
    EXPECT_THROW(medium->SetRate(0ms, Medium::MostBitsPerSecond + 1), std::invalid_argument);
}

TEST_F(MediumTest, DuringAnOutageTheAirIsUsedAndNobodyHears)
{
    Make(3, 1'000'000);
    medium->SetOutage(0ms, true);
    medium->Offer(0ms, 0, Multicast(1000));
    EXPECT_THAT(Until(10ms), IsEmpty());
    EXPECT_EQ(medium->Busy(10ms), 8ms);
    EXPECT_EQ(medium->CountersOf(1).Missed, 1u);
    medium->SetOutage(10ms, false);
    medium->Offer(10ms, 0, Multicast(1000));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{18ms, 1}, {18ms, 2}}));
}

TEST_F(MediumTest, AFrameOfWhichAnyPartIsInAnOutageIsNotHeard)
{
    Make(2, 1'000'000);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->SetOutage(2ms, true);
    medium->SetOutage(3ms, false);
    EXPECT_THAT(Until(1s), IsEmpty());
    medium->SetOutage(1s, true);
    medium->Offer(1s, 0, Unicast(1, 1000));
    medium->SetOutage(1s + 1ms, false);
    EXPECT_THAT(Until(2s), IsEmpty());
}

TEST_F(MediumTest, TheWindowFindsTheWorstSecondWhereverItBegins)
{
    SecondWindow window;
    window.Add(100ms, 10);
    window.Add(900ms, 300);
    window.Add(1100ms, 200);  // a second after the first one, which it leaves out
    window.Add(1899ms, 50);
    EXPECT_EQ(window.Most(), 550u);
    window.Add(1900ms, 1);
    EXPECT_EQ(window.Most(), 550u);
    window.Add(5s, 560);
    EXPECT_EQ(window.Most(), 560u);
}

TEST_F(MediumTest, CountersBeginAgainAfterAResetAndTheAirDoesNot)
{
    Make(2, 1'000'000);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->Reset(4ms);
    EXPECT_EQ(medium->CountersOf(0).Offered.Frames, 0u);
    EXPECT_EQ(medium->Busy(6ms), 2ms);
    EXPECT_EQ(Until(1s).size(), 2u);
    EXPECT_EQ(medium->Busy(1s), 12ms);
    EXPECT_EQ(medium->CountersOf(0).Unicast.Frames, 2u);
    EXPECT_EQ(medium->CountedSince(), 4ms);
}

TEST_F(MediumTest, ATimeThatGoesBackCountsAsTheLastOne)
{
    Make(2, 1'000'000);
    medium->Offer(10ms, 0, Unicast(1, 1000));
    medium->Offer(5ms, 0, Unicast(1, 1000));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{18ms, 1}, {26ms, 1}}));
}

TEST_F(MediumTest, TheTapSeesEachFrameOnceAtTheEndOfItsAir)
{
    Make(3, 1'000'000);
    Change(0, 1, 1);
    std::vector<std::pair<Time, std::size_t>> seen;
    medium->SetTap([&](Time at, const Frame &frame) { seen.emplace_back(at, frame.size()); });
    medium->Offer(0ms, 0, Multicast(1000));
    medium->Offer(0ms, 1, Unicast(2, 500));
    Until(1s);
    EXPECT_EQ(seen, (std::vector<std::pair<Time, std::size_t>>{{8ms, 1000}, {12ms, 500}}));
}

TEST_F(MediumTest, LossesComeInBurstsOfTheLengthAskedForAndInTheShareAskedFor)
{
    Make(2, std::nullopt);
    medium->SetLink(0s, 0, 1, {.Loss = 0.2, .Burst = 8});
    std::size_t lost = 0;
    std::size_t bursts = 0;
    bool wasLost = false;
    constexpr int frames = 100'000;
    for (int k = 0; k < frames; ++k)
    {
        medium->Offer(std::chrono::milliseconds(k), 0, Unicast(1, 100));
        const bool isLost = Until(std::chrono::milliseconds(k)).empty();
        lost += isLost ? 1 : 0;
        bursts += isLost && !wasLost ? 1 : 0;
        wasLost = isLost;
    }
    EXPECT_NEAR(static_cast<double>(lost) / frames, 0.2, 0.02);
    EXPECT_NEAR(static_cast<double>(lost) / static_cast<double>(bursts), 8, 0.8);
}

TEST_F(MediumTest, ALossNearAllKeepsItsShareWithLongerBursts)
{
    Make(2, std::nullopt);
    medium->SetLink(0s, 0, 1, {.Loss = 0.95, .Burst = 2});
    std::size_t heard = 0;
    for (int k = 0; k < 20'000; ++k)
    {
        medium->Offer(std::chrono::milliseconds(k), 0, Unicast(1, 100));
        heard += Until(std::chrono::milliseconds(k)).size();
    }
    EXPECT_NEAR(static_cast<double>(heard) / 20'000, 0.05, 0.02);
}

TEST_F(MediumTest, HiddenStationsSendAtTheSameTimeAndSpoilEachOthersFramesAtAThird)
{
    Make(3, 1'000'000);
    medium->SetHidden(0s, 0, 2, true);
    medium->Offer(0ms, 0, Unicast(1, 1000));
    medium->Offer(1ms, 2, Unicast(1, 1000));
    EXPECT_THAT(Until(1s), IsEmpty());
    EXPECT_EQ(medium->CountersOf(1).Collided, 2u);
    EXPECT_EQ(medium->Busy(1s), 9ms);
    medium->Offer(1s, 0, Unicast(1, 1000));
    medium->Offer(1s + 8ms, 2, Unicast(1, 1000));  // begins when the first one ends
    EXPECT_EQ(ArrivalsUntil(2s), (Arrivals{{1s + 8ms, 1}, {1s + 16ms, 1}}));
}

TEST_F(MediumTest, AFrameOfAHiddenStationIsSpoiledOnlyWhereTheOtherIsHeard)
{
    Make(4, 1'000'000);
    medium->SetHidden(0s, 0, 2, true);
    medium->SetHidden(0s, 2, 3, true);
    medium->Offer(0ms, 0, Multicast(1000));
    medium->Offer(0ms, 2, Multicast(1000));
    EXPECT_EQ(ArrivalsUntil(1s), (Arrivals{{8ms, 3}}));  // 1 hears both, 3 hears 0 alone
}

TEST_F(MediumTest, StationsThatAreNotHiddenAnyMoreTakeTurnsAgain)
{
    Make(3, 1'000'000);
    medium->SetHidden(0s, 0, 2, true);
    medium->SetHidden(1s, 0, 2, false);
    medium->Offer(1s, 0, Unicast(1, 1000));
    medium->Offer(1s, 2, Unicast(1, 1000));
    EXPECT_EQ(ArrivalsUntil(2s), (Arrivals{{1s + 8ms, 1}, {1s + 16ms, 1}}));
}

TEST_F(MediumTest, TwoOfOneNameOrAddressAreRefused)
{
    Make(2, 1'000);
    EXPECT_THROW(medium->Add("n0", AddressOf(9)), std::invalid_argument);
    EXPECT_THROW(medium->Add("other", AddressOf(1)), std::invalid_argument);
}

TEST_F(MediumTest, ANodeThatIsAddedLaterLeavesTheLinksAsTheyAre)
{
    Make(2, std::nullopt);
    Change(1, 0, 0.5);
    medium->Add("late", AddressOf(2));
    EXPECT_EQ(medium->LinkOf(1, 0).Loss, 0.5);
    EXPECT_EQ(medium->LinkOf(0, 2).Loss, 0);
}

}  // namespace
}  // namespace Rabit::Radio
