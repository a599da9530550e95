#include "air/AirSchedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <vector>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Duration = AirSchedule::Duration;

// Streams that always have a datagram, and the bytes that each has sent.
class AirScheduleTest : public ::testing::Test
{
protected:
    StreamId Add(TrafficClass traffic, std::size_t bytes, double weight = 1.0)
    {
        const StreamId id = Schedule.AddStream(traffic, weight);
        _bytes[id.Index] = bytes;
        Schedule.Ready(id, bytes);
        return id;
    }

    // Sends this many datagrams, without a limit.
    void SendMany(int datagrams)
    {
        for (int i = 0; i < datagrams; ++i)
        {
            const auto next = Schedule.Next(0ns);
            ASSERT_TRUE(next);
            Send(*next, 0ns);
        }
    }

    void Send(StreamId id, Duration now)
    {
        Schedule.Sent(id, _bytes.at(id.Index), now);
        Schedule.Ready(id, _bytes.at(id.Index));
    }

    // Sends from one time to another, with a limit.
    void SendUntil(Duration from, Duration to)
    {
        for (Duration now = from; now < to; now = std::max(Schedule.NextDue(now), now + 1ns))
        {
            while (const auto next = Schedule.Next(now))
            {
                Send(*next, now);
            }
        }
    }

    double Share(StreamId id, StreamId other) const
    {
        return static_cast<double>(Schedule.SentBytes(id)) / static_cast<double>(Schedule.SentBytes(other));
    }

    AirSchedule Schedule{1428};

private:
    std::map<std::uint32_t, std::size_t> _bytes;
};

TEST_F(AirScheduleTest, WhoHasNothingIsNotAsked)
{
    EXPECT_FALSE(Schedule.Next(0ns));
    EXPECT_EQ(Schedule.NextDue(0ns), AirSchedule::Never);
    const StreamId id = Add(TrafficClass::State, 100);
    EXPECT_EQ(Schedule.Next(0ns), id);
    EXPECT_EQ(Schedule.NextDue(5ns), 5ns);
    Schedule.NotReady(id);
    EXPECT_FALSE(Schedule.Next(0ns));
    Schedule.Ready(id, 100);
    Schedule.Remove(id);
    EXPECT_FALSE(Schedule.Next(0ns));
}

TEST_F(AirScheduleTest, WhoHasSentIsAskedAgainOnlyWhenItIsReady)
{
    const StreamId id = Add(TrafficClass::State, 100);
    Schedule.Sent(id, 100, 0ns);
    EXPECT_FALSE(Schedule.Next(0ns));
    Schedule.Ready(id, 100);
    EXPECT_EQ(Schedule.Next(0ns), id);
    EXPECT_EQ(Schedule.SentBytes(id), 100u);
    EXPECT_EQ(Schedule.SentBytes(TrafficClass::State), 100u);
    EXPECT_EQ(Schedule.SentBytes(TrafficClass::Command), 0u);
}

TEST_F(AirScheduleTest, TheAnswerStaysUntilSomethingChanges)
{
    Add(TrafficClass::State, 100);
    Add(TrafficClass::Bulk, 100);
    Add(TrafficClass::Bulk, 100);
    for (int i = 0; i < 100; ++i)
    {
        const auto next = Schedule.Next(0ns);
        EXPECT_EQ(Schedule.Next(0ns), next);
        EXPECT_EQ(Schedule.NextDue(0ns), 0ns);
        Send(*next, 0ns);
    }
}

TEST_F(AirScheduleTest, AStreamThatIsNotThereIsAProgrammingError)
{
    const StreamId id = Schedule.AddStream(TrafficClass::State);
    Schedule.Remove(id);
    EXPECT_THROW(Schedule.Ready(id, 1), std::out_of_range);
    const StreamId other = Schedule.AddStream(TrafficClass::State);
    EXPECT_NE(other, id);
    EXPECT_THROW(Schedule.Sent(id, 1, 0ns), std::out_of_range);
    EXPECT_THROW(Schedule.AddStream(TrafficClass::State, 0.0), std::invalid_argument);
    EXPECT_THROW(Schedule.AddStream(TrafficClass::State, 101.0), std::invalid_argument);
}

TEST_F(AirScheduleTest, ClassesShareByTheirQuanta)
{
    const StreamId command = Add(TrafficClass::Command, 160);
    const StreamId state = Add(TrafficClass::State, 300);
    const StreamId telemetry = Add(TrafficClass::Telemetry, 190);
    const StreamId bulk = Add(TrafficClass::Bulk, 1400);
    const StreamId foreign = Add(TrafficClass::Foreign, 290);
    SendMany(100'000);
    EXPECT_NEAR(Share(command, bulk), 16.0, 0.1);
    EXPECT_NEAR(Share(state, bulk), 4.0, 0.05);
    EXPECT_NEAR(Share(telemetry, bulk), 1.5, 0.05);
    EXPECT_NEAR(Share(foreign, bulk), 1.5, 0.05);
}

TEST_F(AirScheduleTest, TheShareOfWhoHasNothingIsThatOfTheOthers)
{
    const StreamId telemetry = Add(TrafficClass::Telemetry, 190);
    const StreamId bulk = Add(TrafficClass::Bulk, 1400);
    SendMany(10'000);
    EXPECT_NEAR(Share(telemetry, bulk), 1.5, 0.05);
    Schedule.NotReady(telemetry);
    const auto before = Schedule.SentBytes(bulk);
    SendMany(100);
    EXPECT_EQ(Schedule.SentBytes(bulk), before + 140'000);
}

TEST_F(AirScheduleTest, ACommandGoesNextHoweverMuchWaits)
{
    for (int i = 0; i < 100; ++i)
    {
        Add(TrafficClass::State, 300);
        Add(TrafficClass::Telemetry, 200);
        Add(TrafficClass::Bulk, 1400);
    }
    const StreamId command = Schedule.AddStream(TrafficClass::Command);
    for (int i = 0; i < 100; ++i)
    {
        SendMany(30);
        Schedule.Ready(command, 160);
        EXPECT_EQ(Schedule.Next(0ns), command);
        Schedule.Sent(command, 160, 0ns);
    }
}

TEST_F(AirScheduleTest, TelemetryIsNotHeldUpForTheCommandsOfWhichItHasHadItsShareAtOnce)
{
    Add(TrafficClass::Command, 200);
    const StreamId pose = Add(TrafficClass::Telemetry, 104);
    std::size_t others = 0;
    std::size_t longest = 0;
    for (int i = 0; i < 1000; ++i)
    {
        const StreamId next = *Schedule.Next(0ns);
        others = next == pose ? 0 : others + 200;
        longest = std::max(longest, others);
        Send(next, 0ns);
    }
    EXPECT_LE(longest, 104 * 32 / 3 + 2 * 200);
}

TEST_F(AirScheduleTest, AClassThatComesAndGoesHasNoMoreThanItsShare)
{
    const StreamId command = Schedule.AddStream(TrafficClass::Command);
    const StreamId bulk = Add(TrafficClass::Bulk, 400);
    // A command is ready whenever one has been sent, and not ready in between.
    for (int i = 0; i < 100'000; ++i)
    {
        Schedule.Ready(command, 160);
        const auto next = Schedule.Next(0ns);
        Schedule.Sent(*next, *next == bulk ? 400 : 160, 0ns);
        Schedule.NotReady(command);
        Schedule.Ready(bulk, 400);
    }
    EXPECT_NEAR(Share(command, bulk), 16.0, 0.2);
}

TEST_F(AirScheduleTest, PresenceGoesFirst)
{
    Add(TrafficClass::Command, 100);
    const StreamId presence = Schedule.AddStream(TrafficClass::Presence);
    for (int i = 0; i < 100; ++i)
    {
        SendMany(10);
        Schedule.Ready(presence, 100);
        EXPECT_EQ(Schedule.Next(0ns), presence);
        Schedule.Sent(presence, 100, 0ns);
    }
}

TEST_F(AirScheduleTest, PresenceOfAThousandNamesHasAQuarter)
{
    Schedule.SetBudget(5000, 0ns);
    std::vector<StreamId> presence;
    for (int i = 0; i < 1000; ++i)
    {
        presence.push_back(Add(TrafficClass::Presence, 120));
    }
    Add(TrafficClass::Command, 160);
    Add(TrafficClass::Bulk, 400);
    SendUntil(0s, 100s);
    const auto all = static_cast<double>(Schedule.SentBytes(TrafficClass::Presence) +
                                         Schedule.SentBytes(TrafficClass::Command) +
                                         Schedule.SentBytes(TrafficClass::Bulk));
    EXPECT_NEAR(static_cast<double>(Schedule.SentBytes(TrafficClass::Presence)) / all, 0.25, 0.01);
    EXPECT_GE(all, 0.85 * 100 * 5000);
}

TEST_F(AirScheduleTest, PresenceThatIsAloneIsFreeAndGoesFirstAfterwards)
{
    Schedule.SetBudget(5000, 0ns);
    const StreamId presence = Add(TrafficClass::Presence, 120);
    SendUntil(0s, 20s);
    EXPECT_GE(Schedule.SentBytes(presence), 80'000u);
    Add(TrafficClass::Command, 160);
    EXPECT_EQ(Schedule.Next(25s), presence);
}

TEST_F(AirScheduleTest, StreamsOfAClassShareByWeight)
{
    const StreamId one = Add(TrafficClass::Telemetry, 100);
    const StreamId three = Add(TrafficClass::Telemetry, 700, 3.0);
    const StreamId half = Add(TrafficClass::Telemetry, 1400, 0.5);
    SendMany(20'000);
    EXPECT_NEAR(Share(three, one), 3.0, 0.02);
    EXPECT_NEAR(Share(half, one), 0.5, 0.02);
}

TEST_F(AirScheduleTest, AThousandStreamsOfOneWeightTakeTurns)
{
    std::vector<StreamId> streams;
    for (int i = 0; i < 1000; ++i)
    {
        streams.push_back(Add(TrafficClass::Telemetry, 190));
    }
    SendMany(10'000);
    for (const StreamId id : streams)
    {
        EXPECT_EQ(Schedule.SentBytes(id), 1900u);
    }
}

TEST_F(AirScheduleTest, WhoHadNothingForLongHasNoRightToMore)
{
    const StreamId often = Add(TrafficClass::State, 100);
    const StreamId seldom = Schedule.AddStream(TrafficClass::State);
    SendMany(1000);
    const auto before = Schedule.SentBytes(often);
    for (int i = 0; i < 100; ++i)
    {
        Schedule.Ready(seldom, 100);
        const auto next = Schedule.Next(0ns);
        Schedule.Sent(*next, 100, 0ns);
        Schedule.Ready(*next, 100);
    }
    EXPECT_NEAR(static_cast<double>(Schedule.SentBytes(often) - before), 5000.0, 100.0);
}

TEST_F(AirScheduleTest, AStreamMayBeRemovedFromTheMiddle)
{
    std::vector<StreamId> streams;
    for (int i = 0; i < 100; ++i)
    {
        streams.push_back(Add(TrafficClass::Telemetry, static_cast<std::size_t>(100 + i * 7 % 50)));
    }
    SendMany(500);
    for (std::size_t i = 0; i < streams.size(); i += 3)
    {
        Schedule.Remove(streams[i]);
    }
    const auto before = Schedule.SentBytes(streams[1]);
    SendMany(6700);
    for (std::size_t i = 0; i < streams.size(); ++i)
    {
        if (i % 3 != 0)
        {
            EXPECT_NEAR(static_cast<double>(Schedule.SentBytes(streams[i])),
                        static_cast<double>(Schedule.SentBytes(streams[1])), 300.0);
        }
    }
    EXPECT_GT(Schedule.SentBytes(streams[1]), before + 10'000);
}

TEST_F(AirScheduleTest, WithABudgetTheNextOneIsDueWhenTheLastHasHadItsTime)
{
    Schedule.SetBudget(1500, 0ns);
    const StreamId bulk = Add(TrafficClass::Bulk, 300);
    EXPECT_EQ(Schedule.Next(10s), bulk);
    Send(bulk, 10s);
    EXPECT_FALSE(Schedule.Next(10s));
    const Duration due = Schedule.NextDue(10s);
    EXPECT_NEAR(std::chrono::duration<double>(due).count(), 10.2, 0.02);
    EXPECT_FALSE(Schedule.Next(due - 2ms));
    EXPECT_EQ(Schedule.Next(due), bulk);
}

TEST_F(AirScheduleTest, ADriverIsNotWokenMoreOftenThanOnceAMillisecond)
{
    Schedule.SetPace(10e6, 0ns);
    const StreamId bulk = Add(TrafficClass::Bulk, 1400);
    int wakes = 0;
    for (Duration now = 1s; now < 2s; now = Schedule.NextDue(now))
    {
        ++wakes;
        while (Schedule.Next(now))
        {
            Send(bulk, now);
        }
    }
    EXPECT_LE(wakes, 1000);
    EXPECT_NEAR(static_cast<double>(Schedule.SentBytes(bulk)), 10e6, 0.15e6);
}

TEST_F(AirScheduleTest, AClassThatHadNothingForLongHasNoMoreThanARound)
{
    const StreamId command = Schedule.AddStream(TrafficClass::Command);
    const StreamId bulk = Add(TrafficClass::Bulk, 400);
    SendMany(1000);
    const auto before = Schedule.SentBytes(bulk);
    for (int i = 0; i < 100; ++i)
    {
        Schedule.Ready(command, 160);
        const auto next = Schedule.Next(0ns);
        Schedule.Sent(*next, *next == bulk ? 400 : 160, 0ns);
        Schedule.Ready(bulk, 400);
    }
    EXPECT_GE(Schedule.SentBytes(bulk), before + 800);
}

TEST_F(AirScheduleTest, ACommandWithoutCreditPassesWhatDoesNotFitYet)
{
    const StreamId state = Add(TrafficClass::State, 1200);
    const StreamId command = Schedule.AddStream(TrafficClass::Command);
    const StreamId telemetry = Schedule.AddStream(TrafficClass::Telemetry);
    Schedule.Sent(command, 1700, 0ns);
    Schedule.SetBudget(1500, 1s);
    Schedule.Sent(telemetry, 400, 10s);
    Schedule.Ready(command, 160);
    EXPECT_EQ(Schedule.Next(10400ms), command);
    Schedule.NotReady(command);
    EXPECT_FALSE(Schedule.Next(10400ms));
    EXPECT_EQ(Schedule.Next(11100ms), state);
}

TEST_F(AirScheduleTest, ACommandPassesWhatDoesNotFitYet)
{
    Schedule.SetBudget(1500, 0ns);
    const StreamId state = Add(TrafficClass::State, 1200);
    const StreamId command = Schedule.AddStream(TrafficClass::Command);
    Send(state, 10s);
    EXPECT_FALSE(Schedule.Next(10900ms));
    Schedule.Ready(command, 160);
    EXPECT_EQ(Schedule.Next(10900ms), command);
}

TEST_F(AirScheduleTest, WhatIsLargeIsNotPassedForEver)
{
    Schedule.SetBudget(1500, 0ns);
    const StreamId state = Add(TrafficClass::State, 1300);
    Add(TrafficClass::Command, 160);
    SendUntil(0s, 60s);
    EXPECT_GE(Schedule.SentBytes(state), 4u * 1300);
}

TEST_F(AirScheduleTest, NextDueIsWhenNextAnswers)
{
    Schedule.SetBudget(2500, 0ns);
    Schedule.Reserve(200);
    Add(TrafficClass::Presence, 120);
    Add(TrafficClass::Command, 160);
    Add(TrafficClass::State, 900);
    Add(TrafficClass::Bulk, 600);
    Duration now = 0s;
    for (int i = 0; i < 2000; ++i)
    {
        while (const auto next = Schedule.Next(now))
        {
            Send(*next, now);
        }
        const Duration due = Schedule.NextDue(now);
        ASSERT_GT(due, now);
        ASSERT_TRUE(Schedule.Next(due) || Schedule.NextDue(due) > due);
        now = due;
    }
    EXPECT_GE(now, 100s);
}

TEST_F(AirScheduleTest, WithTenTimesTheBudgetOfferedACommandWaitsForOneDatagramAndItsShare)
{
    constexpr double Rate = 5000.0;
    Schedule.SetBudget(Rate, 0ns);
    for (int i = 0; i < 20; ++i)
    {
        Add(TrafficClass::Telemetry, 190);
        Add(TrafficClass::State, 400);
        Add(TrafficClass::Bulk, Schedule.Budget().LargestDatagram());
    }
    const StreamId beat = Schedule.AddStream(TrafficClass::Presence);
    const StreamId command = Schedule.AddStream(TrafficClass::Command);
    std::vector<Duration> waits;
    Duration ready = Duration::max();
    Duration readyAt = 1s;
    for (Duration now = 0s; now < 300s; now += 1ms)
    {
        if (now % 500ms == 0ns)
        {
            Schedule.Ready(beat, 120);
        }
        if (now >= readyAt && ready == Duration::max())
        {
            ready = now;
            readyAt = now + 137ms + now % 211ms;
            Schedule.Ready(command, 160);
        }
        while (const auto next = Schedule.Next(now))
        {
            if (*next == beat)
            {
                Schedule.Sent(beat, 120, now);
            }
            else if (*next == command)
            {
                Schedule.Sent(command, 160, now);
                waits.push_back(now - ready);
                ready = Duration::max();
            }
            else
            {
                Send(*next, now);
            }
        }
    }
    std::sort(waits.begin(), waits.end());
    ASSERT_GT(waits.size(), 800u);
    // A command waits for a beat under way and for the largest datagram.
    const auto datagram =
        std::chrono::duration<double>(static_cast<double>(Schedule.Budget().LargestDatagram()) / Rate);
    EXPECT_LE(waits[waits.size() * 99 / 100], 2 * datagram);
    EXPECT_LE(waits[waits.size() / 2], datagram);
}

// A beat of 150 bytes, promised every 600 ms, on a budget of 5000 B/s.
class PromiseTest : public AirScheduleTest
{
protected:
    static constexpr Duration Period = 600ms;

    PromiseTest()
    {
        Schedule.SetBudget(5000, 0ns);
        Beat = Schedule.AddStream(TrafficClass::Presence, AirSchedule::LargestWeight);
    }

    void SendBeat(Duration now)
    {
        Longest = std::max(Longest, now - SentAt);
        Shortest = std::min(Shortest, now - SentAt);
        ++Beats;
        SentAt = now;
        Schedule.Sent(Beat, 150, now);
        Schedule.Promise(Beat, 150, now + Period);
    }

    // Sends the streams that the schedule chooses. A beat goes at the latest when it is due.
    void Run(Duration from, Duration to)
    {
        SentAt = from - Period;
        SendBeat(from);
        Duration now = from;
        while (now < to)
        {
            if (now >= SentAt + Period)
            {
                Schedule.Ready(Beat, 150);
            }
            while (const auto next = Schedule.Next(now))
            {
                *next == Beat ? SendBeat(now) : Send(*next, now);
            }
            const Duration due = Schedule.NextDue(now);
            ASSERT_GT(due, now);
            now = now < SentAt + Period ? std::min(due, SentAt + Period) : due;
            ++Wakes;
        }
    }

    StreamId Beat;
    Duration SentAt{0};
    Duration Longest{0};
    Duration Shortest = 1h;
    int Beats = 0;
    int Wakes = 0;
};

TEST_F(PromiseTest, IsKeptBesideAnyNumberOfAcknowledgements)
{
    Add(TrafficClass::Command, 160);
    Add(TrafficClass::Bulk, Schedule.Budget().LargestDatagram());
    for (const int peers : {20, 50})
    {
        for (int i = 0; i < peers; ++i)
        {
            Add(TrafficClass::Presence, 120);
        }
        Run(peers * 100s, peers * 100s + 100s);
        EXPECT_LE(Longest, Period) << peers;
        // A beat goes early by at most the time of another datagram.
        EXPECT_GE(Shortest, Period - 300ms) << peers;
        EXPECT_LE(Beats, 300) << peers;
        Beats = 0;
    }
}

TEST_F(PromiseTest, GoesEarlyBeforeADatagramThatWouldMakeItLate)
{
    const StreamId bulk = Add(TrafficClass::Bulk, 1000);
    Schedule.Promise(Beat, 150, 10s);
    EXPECT_EQ(Schedule.Next(9700ms), bulk);
    EXPECT_EQ(Schedule.Next(9900ms), Beat) << "although it is not ready: the other one takes 200 ms";
    Schedule.Sent(Beat, 150, 9900ms);
    EXPECT_EQ(Schedule.Next(10s), bulk) << "a promise is kept once";
}

TEST_F(PromiseTest, ACommandDoesNotPassIt)
{
    Add(TrafficClass::State, 3000);
    Add(TrafficClass::Command, 160);
    Run(1s, 60s);
    EXPECT_LE(Longest, Period + 1s) << "what is kept goes before it";
}

TEST_F(PromiseTest, DoesNotStarveWhatNeedsMoreThanItsPeriod)
{
    const StreamId large = Add(TrafficClass::State, 4000);
    const StreamId larger = Add(TrafficClass::Bulk, 9000);
    Run(1s, 101s);
    EXPECT_GE(Schedule.SentBytes(large), 20u * 4000);
    EXPECT_GE(Schedule.SentBytes(larger), 5u * 9000);
    EXPECT_GE(Beats, 60);
    EXPECT_LE(Wakes, 2000);
}

TEST_F(PromiseTest, HoldsWithoutALimitOnlyOnceThereIsOne)
{
    Schedule.SetLimits({}, {}, 0ns);
    const StreamId bulk = Add(TrafficClass::Bulk, 1000);
    Schedule.Promise(Beat, 150, 1s);
    EXPECT_EQ(Schedule.Next(2s), bulk);
    Schedule.SetBudget(5000, 2s);
    EXPECT_EQ(Schedule.Next(2s), Beat);
}

TEST_F(PromiseTest, EndsWithItsStream)
{
    const StreamId bulk = Add(TrafficClass::Bulk, 1000);
    Schedule.Promise(Beat, 150, 1s);
    Schedule.Remove(Beat);
    EXPECT_EQ(Schedule.Next(2s), bulk);
    EXPECT_THROW(Schedule.Promise(Beat, 150, 3s), std::out_of_range);
}

// A stream whose last datagram went to a group, or elsewhere, with a budget that leaves room.
class AirRiderTest : public AirScheduleTest
{
protected:
    AirRiderTest() { Schedule.SetBudget(5000, 0ns); }
    StreamId AddThatWent(TrafficClass traffic, std::size_t bytes, const AirSchedule::Destinations &to,
                         double weight = 1.0)
    {
        const StreamId id = Add(traffic, bytes, weight);
        Schedule.Went(id, to);
        return id;
    }
    std::optional<StreamId> Rider(std::size_t room = 1000, TrafficClass first = TrafficClass::Presence)
    {
        return Schedule.NextRider(first, Group, room, 0ns);
    }

    const AirSchedule::Destinations Group{1, 1};
    const AirSchedule::Destinations Elsewhere{2, 1};
};

TEST_F(AirRiderTest, TheNextStreamRidesIfItGoesToTheSamePlace)
{
    EXPECT_FALSE(Rider());
    const StreamId pose = AddThatWent(TrafficClass::Telemetry, 148, Group);
    EXPECT_EQ(Rider(), pose);
    const StreamId beat = AddThatWent(TrafficClass::Presence, 150, Group);
    EXPECT_EQ(Rider(), beat);
    const StreamId command = Add(TrafficClass::Command, 160);
    Schedule.Sent(beat, 100, 0ns);
    EXPECT_FALSE(Rider()) << "the next one went nowhere yet";
    Schedule.Went(command, Elsewhere);
    EXPECT_FALSE(Rider());
    Schedule.NotReady(command);
    EXPECT_EQ(Rider(), pose);
    EXPECT_FALSE(Schedule.NextRider(TrafficClass::Presence, {}, 1000, 0ns))
        << "behind a datagram that was not kept";
}

TEST_F(AirRiderTest, ARiderNeedsRoomForItsBytesButNotForItsHeaders)
{
    AddThatWent(TrafficClass::Telemetry, 148, Group);
    EXPECT_TRUE(Rider(148 - AirSchedule::JoinedHeaders));
    EXPECT_FALSE(Rider(148 - AirSchedule::JoinedHeaders - 1));
}

TEST_F(AirRiderTest, TheRoomIsThatOfEachCopy)
{
    const AirSchedule::Destinations three{3, 3};
    AddThatWent(TrafficClass::Telemetry, 3 * 148, three);
    EXPECT_TRUE(Schedule.NextRider(TrafficClass::Presence, three, 148 - AirSchedule::JoinedHeaders, 0ns));
    EXPECT_FALSE(
        Schedule.NextRider(TrafficClass::Presence, three, 148 - AirSchedule::JoinedHeaders - 1, 0ns));
}

TEST_F(AirRiderTest, ARiderFitsTheBudgetAsIfItWentAlone)
{
    const StreamId pose = AddThatWent(TrafficClass::Telemetry, 148, Group);
    Schedule.SentPast(4800, 0ns);
    EXPECT_EQ(Rider(), pose);
    Schedule.SentPast(100, 0ns);
    EXPECT_FALSE(Rider());
}

TEST_F(AirRiderTest, WithoutALimitNobodyRides)
{
    AirSchedule unlimited(1428);
    const StreamId id = unlimited.AddStream(TrafficClass::State);
    unlimited.Ready(id, 100);
    unlimited.Went(id, Group);
    EXPECT_FALSE(unlimited.NextRider(TrafficClass::State, Group, 1000, 0ns));
}

TEST_F(AirRiderTest, AStreamThatMayRideIsNotChosenButRides)
{
    const StreamId beat = Schedule.AddStream(TrafficClass::Presence);
    Schedule.Went(beat, Group);
    Schedule.MayRide(beat, 150);
    EXPECT_FALSE(Schedule.Next(0ns));
    const StreamId pose = AddThatWent(TrafficClass::Telemetry, 148, Group);
    EXPECT_EQ(Schedule.Next(0ns), pose);
    Schedule.Sent(pose, 148, 0ns);
    EXPECT_EQ(Rider(), beat);
    Schedule.Sent(beat, 102, 0ns);
    EXPECT_FALSE(Rider()) << "it has sent";
    Schedule.MayRide(beat, 150);
    Schedule.NotReady(beat);
    EXPECT_FALSE(Rider());
}

TEST_F(AirRiderTest, AnEarlyStreamThatDoesNotFitKeepsNobodyFromRiding)
{
    const StreamId beat = Schedule.AddStream(TrafficClass::Presence);
    Schedule.Went(beat, Group);
    Schedule.MayRide(beat, 500);
    const StreamId pose = AddThatWent(TrafficClass::Telemetry, 148, Group);
    EXPECT_EQ(Rider(200), pose);
}

TEST_F(AirRiderTest, ARiderDoesNotMakeAPromisedDatagramLate)
{
    const StreamId beat = Schedule.AddStream(TrafficClass::Presence);
    const StreamId pose = AddThatWent(TrafficClass::Telemetry, 400, Group);
    Schedule.Promise(beat, 150, 500ms);
    EXPECT_EQ(Rider(), pose);
    Schedule.SentPast(2000, 0ns);  // takes 420 ms
    EXPECT_FALSE(Rider());
}

// A message with one place to wait has nothing right after it was sent.
TEST_F(AirRiderTest, AStreamDoesNotRideAheadOfItsShareWhileTheOthersHaveNothing)
{
    const StreamId heavy = AddThatWent(TrafficClass::Telemetry, 100, Group, 3.0);
    const StreamId light = AddThatWent(TrafficClass::Telemetry, 100, Group);
    Duration now = 0ns;
    for (int i = 0; i < 10'000; ++i)
    {
        now = std::max(Schedule.NextDue(now), now + 1ns);
        while (const auto next = Schedule.Next(now))
        {
            Schedule.Sent(*next, 100, now);
            const auto rider = Schedule.NextRider(TrafficClass::Telemetry, Group, 1000, now);
            if (rider)
            {
                Schedule.Sent(*rider, 100, now);
            }
            Schedule.Ready(heavy, 100);
            Schedule.Ready(light, 100);
        }
    }
    EXPECT_NEAR(Share(heavy, light), 3.0, 0.1);
}

TEST_F(AirRiderTest, AClassDoesNotRideWithoutCredit)
{
    const StreamId pose = AddThatWent(TrafficClass::Telemetry, 148, Group);
    const StreamId bulk = AddThatWent(TrafficClass::Bulk, 100, Group);
    Schedule.Sent(pose, 148, 0ns);
    EXPECT_EQ(Rider(1000, TrafficClass::Telemetry), bulk);
    Schedule.Sent(bulk, 100, 0ns);
    Schedule.Ready(bulk, 100);
    EXPECT_FALSE(Rider(1000, TrafficClass::Telemetry));
    EXPECT_EQ(Rider(1000, TrafficClass::Bulk), bulk) << "within its own datagram";
    EXPECT_EQ(Rider(1000, TrafficClass::Presence), bulk) << "behind a beat";
}

TEST_F(AirRiderTest, NobodyRidesWhileALargeDatagramWaits)
{
    const StreamId bulk = AddThatWent(TrafficClass::Bulk, 1400, Elsewhere);
    Schedule.SetBudget(2000, 0ns);
    Schedule.SentPast(1000, 0ns);
    EXPECT_FALSE(Schedule.Next(700ms)) << "the second is too full";
    const StreamId command = AddThatWent(TrafficClass::Command, 160, Group);
    EXPECT_EQ(Schedule.Next(700ms), command);
    Schedule.Sent(command, 160, 700ms);
    Schedule.Ready(command, 160);
    EXPECT_FALSE(Schedule.NextRider(TrafficClass::Command, Group, 1000, 700ms));
    Schedule.NotReady(bulk);
    EXPECT_EQ(Schedule.NextRider(TrafficClass::Command, Group, 1000, 700ms), command);
}

TEST_F(AirRiderTest, ClassesAndStreamsHaveTheirSharesHoweverManyRide)
{
    const StreamId command = AddThatWent(TrafficClass::Command, 100, Group);
    const StreamId bulk = AddThatWent(TrafficClass::Bulk, 100, Group);
    const StreamId heavy = AddThatWent(TrafficClass::Bulk, 100, Group, 3.0);
    int rode = 0;
    for (Duration now = 0s; now < 1000s; now = std::max(Schedule.NextDue(now), now + 1ns))
    {
        while (const auto next = Schedule.Next(now))
        {
            Send(*next, now);
            std::size_t room = 400;
            while (const auto rider = Schedule.NextRider(Schedule.ClassOf(*next), Group, room, now))
            {
                Send(*rider, now);
                room -= 52;
                ++rode;
            }
        }
    }
    EXPECT_GT(rode, 10'000);
    EXPECT_NEAR(Share(heavy, bulk), 3.0, 0.02);
    EXPECT_NEAR(Share(command, bulk) / 4.0, 16.0, 0.2);
}

}  // namespace
}  // namespace Rabit
