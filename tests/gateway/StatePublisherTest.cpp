// When a State is written, under which version, and when it is repeated.
#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitWorkspace.h>

#include <algorithm>
#include <memory>

#include "OneWriterNetwork.h"
#include "TelemetryPublisher.h"
#include "mirrors/TopicPublisher.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using OneWriter::Network;
using OneWriter::Session;

// A publisher with a local message that is posted.
class StatePublisherTest : public testing::Test
{
protected:
    StatePublisherTest()
    {
        workspace.AddPublishSubscribeMessage("Pose", pose);
        workspace.AddPublishSubscribeMessage("Pose", publisher.Local());
        publisher.SetAttached();
    }

    // Runs for `duration`, with a request in each step if `ask`. Returns the writes meanwhile.
    int Run(std::chrono::nanoseconds duration, std::chrono::nanoseconds step = 10ms, bool ask = false)
    {
        const int before = network.Writes;
        for (const auto end = Now() + duration; Now() < end;)
        {
            if (ask)
            {
                publisher.AskedFor(Now());
            }
            publisher.Service(Now());
            clock->AdvanceTo(std::min(end, Now() + step));
        }
        return network.Writes - before;
    }

    int Ask()
    {
        publisher.AskedFor(Now());
        return Run(1ms, 1ms);
    }

    int Post()
    {
        pose->PostMessage();
        return Run(1ms, 1ms);
    }

    std::chrono::nanoseconds Now() const { return clock->Monotonic(); }

    std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>(1.4e9, 10s);
    RabitWorkspace workspace{clock};
    Network network;
    Session session{network};
    std::shared_ptr<Uav::Pose> pose = std::make_shared<Uav::Pose>();
    TopicPublisher publisher{
        {.Message = "Pose", .Type = "Uav::Pose"}, Uav::Pose::IdlType(), "uav1", SourceClock(*clock), session};
};

TEST_F(StatePublisherTest, AStateIsWrittenOnceAndItsVersionIsThatOfItsTime)
{
    EXPECT_EQ(publisher.Version(), StateVersion::None);
    EXPECT_EQ(Post(), 1);
    EXPECT_EQ(Run(1h, 1s), 0);
    EXPECT_EQ(publisher.Version(), StateVersion::Of(network.Times.at(0)));
    EXPECT_EQ(network.Times.at(0), StateVersion::Quantised(network.Times.at(0)));
}

// So that a sample and the post in a recording are known to be the same, whatever a backend rounds.
TEST_F(StatePublisherTest, TelemetryHasTimesInTheMiddleOfAStepToo)
{
    TopicPublisher telemetry{{.Message = "Pose", .Type = "Uav::Pose", .Qos = QosProfile::Telemetry},
                             Uav::Pose::IdlType(),
                             "uav1",
                             SourceClock(*clock),
                             session};
    workspace.AddPublishSubscribeMessage("Pose", telemetry.Local());
    telemetry.SetAttached();
    pose->PostMessage();
    telemetry.Service(Now());
    EXPECT_EQ(network.Times.back(), StateVersion::Quantised(network.Times.back()));
    EXPECT_EQ(telemetry.Version(), StateVersion::None);
}

TEST_F(StatePublisherTest, OneThatIsAskedForIsWrittenAgainAsTheSame)
{
    Post();
    const std::uint32_t version = publisher.Version();
    Run(10s);
    EXPECT_EQ(Ask(), 1);
    EXPECT_EQ(network.Times.at(1), network.Times.at(0));
    EXPECT_EQ(publisher.Version(), version);
    EXPECT_EQ(Run(1min), 0) << "once for each time that it is asked for";
}

TEST_F(StatePublisherTest, ThatTheLastPostCanNeverBeWrittenIsToldUntilAnotherOneIsWritten)
{
    EXPECT_FALSE(publisher.IsUnwritable()) << "nothing was posted";
    Post();
    EXPECT_FALSE(publisher.IsUnwritable());
    network.Result = WriteResult::Failed;
    Post();
    EXPECT_TRUE(publisher.IsUnwritable());
    network.Result = WriteResult::TimedOut;
    Post();
    EXPECT_FALSE(publisher.IsUnwritable()) << "it is tried again";
    network.Result = WriteResult::Ok;
    Run(1s);
    EXPECT_FALSE(publisher.IsUnwritable());
}

TEST_F(StatePublisherTest, AllWhoAskTogetherAreAnsweredOnce)
{
    Post();
    Run(10s);
    publisher.AskedFor(Now());
    EXPECT_EQ(Ask(), 1);
    EXPECT_EQ(Ask(), 0) << "asked before the answer came";
    EXPECT_EQ(Run(10s), 0);
}

TEST_F(StatePublisherTest, WhoAsksAgainWaitsTwiceAsLongEachTime)
{
    Post();
    Run(10s);
    EXPECT_EQ(Ask(), 1);
    auto last = Now() - 1ms;
    for (std::chrono::nanoseconds gap = 100ms; gap < 3s; gap *= 2)
    {
        const auto wait = std::min<std::chrono::nanoseconds>(gap, RepeatPace::LongestGap);
        while (Run(1ms, 1ms, true) == 0)
        {
        }
        EXPECT_EQ(Now() - 1ms - last, wait);
        last = Now() - 1ms;
    }
    Run(RepeatPace::Quiet);
    EXPECT_EQ(Ask(), 1) << "as if he were the first";
}

TEST_F(StatePublisherTest, WhoAsksWithoutEndCostsASampleInTwoSeconds)
{
    Post();
    Run(10s);
    EXPECT_LE(Run(10min, 5ms, true), 310);
}

TEST_F(StatePublisherTest, WhoAsksWithoutEndCostsAsMuchAgainAsAQuickState)
{
    int writes = 0;
    for (int posts = 0; posts < 100; ++posts)
    {
        pose->PostMessage();
        writes += Run(100ms, 5ms, true);
    }
    EXPECT_LE(writes, 200);
}

TEST_F(StatePublisherTest, ANewValueIsRepeatedAsQuicklyAsTheFirst)
{
    Post();
    Run(1min, 5ms, true);
    Post();
    EXPECT_EQ(Run(RepeatPace::ShortestGap, 5ms, true), 0);
    EXPECT_EQ(Run(15ms, 5ms, true), 1);
}

TEST_F(StatePublisherTest, NothingIsAskedForBeforeItWasWritten)
{
    EXPECT_EQ(Ask(), 0);
    network.Result = WriteResult::TimedOut;
    Post();
    EXPECT_EQ(publisher.Version(), StateVersion::None);
    network.Result = WriteResult::Ok;
    Run(1s);
    EXPECT_NE(publisher.Version(), StateVersion::None);
}

TEST_F(StatePublisherTest, WhileTheNetworkDoesNotTakeANewValueTheFormerVersionIsTold)
{
    Post();
    const std::uint32_t version = publisher.Version();
    network.Result = WriteResult::TimedOut;
    Post();
    EXPECT_EQ(publisher.Version(), version);
    network.Result = WriteResult::Ok;
    Run(1s);
    EXPECT_NE(publisher.Version(), version);
}

// A rate limit decides when each of its datagrams goes.
TEST_F(StatePublisherTest, ALargeStateIsToldWithItsLastDatagramAndNothingOvertakesIt)
{
    network.Parts = 3;
    pose->PostMessage();
    publisher.Fetch();
    ASSERT_LE(publisher.DueAt(Now()), Now());
    publisher.WriteNext(Now());
    EXPECT_EQ(publisher.Version(), StateVersion::None);
    clock->AdvanceTo(Now() + 1s);
    pose->PostMessage();
    publisher.Fetch();
    EXPECT_EQ(publisher.NextBytes(AirCost(1400)), 1400u);
    for (const std::size_t left : {1u, 0u})
    {
        EXPECT_LE(publisher.DueAt(Now()), Now());
        publisher.WriteNext(Now());
        EXPECT_EQ(network.Held, left);
    }
    EXPECT_EQ(network.Writes, 1);
    const std::uint32_t first = publisher.Version();
    EXPECT_EQ(first, StateVersion::Of(network.Times.at(0)));
    publisher.WriteNext(Now());
    EXPECT_EQ(network.Writes, 2);
    publisher.AskedFor(Now());  // for the first one, by a peer that lacks it
    EXPECT_EQ(publisher.Version(), first);
    publisher.WriteNext(Now());
    publisher.WriteNext(Now());
    EXPECT_EQ(publisher.Version(), StateVersion::Of(network.Times.at(1)));
    EXPECT_EQ(publisher.DueAt(Now()), std::chrono::nanoseconds::max()) << "what was under way is the answer";
}

TEST_F(StatePublisherTest, ALargeStateGoesAtOnceWhenThereIsNoLimitAnyMore)
{
    network.Parts = 3;
    pose->PostMessage();
    publisher.Fetch();
    publisher.WriteNext(Now());
    EXPECT_EQ(Run(1ms, 1ms), 0);
    EXPECT_EQ(network.Held, 0u);
    EXPECT_EQ(publisher.Version(), StateVersion::Of(network.Times.at(0)));
}

TEST_F(StatePublisherTest, WhatCanNeverBeWrittenIsNotAskedFor)
{
    Post();
    network.Result = WriteResult::TooLarge;
    Post();
    EXPECT_EQ(publisher.Version(), StateVersion::None);
    Run(10s);
    EXPECT_EQ(Ask(), 0);
}

TEST_F(StatePublisherTest, OfTwoStatesOfOneMomentTheSecondIsTheLater)
{
    for (int i = 0; i < 5; ++i)
    {
        pose->PostMessage();
        publisher.Service(Now());
    }
    ASSERT_EQ(network.Times.size(), 5u);
    for (std::size_t i = 1; i < 5; ++i)
    {
        EXPECT_GT(network.Times[i], network.Times[i - 1]);
        EXPECT_NE(StateVersion::Of(network.Times[i]), StateVersion::Of(network.Times[i - 1]));
    }
    Post();
    EXPECT_EQ(publisher.Version(), StateVersion::Of(network.Times.back()));
}

TEST_F(StatePublisherTest, NothingIsRepeatedMoreOftenThanTheRuleAllows)
{
    TopicPublisher slow({.Message = "Pose", .Type = "Uav::Pose", .MaxRate = 1}, Uav::Pose::IdlType(), "uav1",
                        SourceClock(*clock), session);
    workspace.AddPublishSubscribeMessage("Pose", slow.Local());
    slow.SetAttached();
    pose->PostMessage();
    slow.Service(Now());
    EXPECT_EQ(network.Writes, 1);
    for (int i = 0; i < 990; ++i)
    {
        clock->AdvanceTo(Now() + 1ms);
        slow.AskedFor(Now());
        slow.Service(Now());
    }
    EXPECT_EQ(network.Writes, 1);
    clock->AdvanceTo(Now() + 20ms);
    slow.Service(Now());
    EXPECT_EQ(network.Writes, 2);
}

TEST(TopicPublisher, TelemetryHasNoVersionAndIsNotRepeated)
{
    TelemetryPublisher telemetry;
    auto &[network, session, publisher, workspace, pose] = telemetry;
    publisher.SetAttached();
    pose->PostMessage();
    publisher.Service(10s);
    EXPECT_EQ(publisher.Version(), StateVersion::None);
    publisher.AskedFor(20s);
    publisher.Service(20s);
    EXPECT_EQ(network.Writes, 1);
}

}  // namespace
}  // namespace Rabit
