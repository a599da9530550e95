// A publisher on a network that takes nothing.
#include "mirrors/TopicPublisher.h"

#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitWorkspace.h>

#include <memory>
#include <vector>

#include "OneWriterNetwork.h"
#include "TelemetryPublisher.h"
#include "keyed.idl.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using OneWriter::Network;
using OneWriter::Session;

// Without a network a write ends at once: without a gap the gateway's thread would do nothing but write.
TEST(TopicPublisher, WhatTheNetworkDoesNotTakeIsTriedAgainAfterAGap)
{
    TelemetryPublisher telemetry;
    auto &[network, session, publisher, workspace, pose] = telemetry;
    publisher.SetAttached();
    pose->PostMessage();

    network.Result = WriteResult::TimedOut;
    std::chrono::nanoseconds now = 10s;
    EXPECT_EQ(publisher.Service(now), now + TopicPublisher::RetryGap);
    pose->PostMessage();
    publisher.Service(now + 1ms);
    EXPECT_EQ(network.Writes, 1);
    now += TopicPublisher::RetryGap;
    network.Result = WriteResult::Ok;
    EXPECT_EQ(publisher.Service(now), std::chrono::nanoseconds::max());
    EXPECT_EQ(network.Writes, 2);
    pose->PostMessage();
    publisher.Service(now + 1ms);
    EXPECT_EQ(network.Writes, 3);
}

TEST(TopicPublisher, ADisposalThatTheNetworkDoesNotTakeIsTriedAgainWithoutTheValue)
{
    Network network;
    Session session(network);
    const PublishRule rule{
        .Message = "Contact", .Type = "GatewayTest::Contact", .Qos = QosProfile::Telemetry};
    TopicPublisher publisher(rule, GatewayTest::Contact::IdlType(), "uav1", SourceClock(ManualClock()),
                             session);
    RabitWorkspace workspace;
    auto contact = std::make_shared<GatewayTest::Contact>();
    workspace.AddPublishSubscribeMessage("Contact", contact);
    workspace.AddPublishSubscribeMessage("Contact", publisher.Local());
    publisher.SetAttached();
    std::chrono::nanoseconds now = 10s;
    contact->PostMessage();
    publisher.Service(now);
    contact->number = 1;
    contact->PostMessage();
    network.DisposalResult = WriteResult::TimedOut;
    now += 1s;
    EXPECT_EQ(publisher.Service(now), now + TopicPublisher::RetryGap);
    EXPECT_EQ(network.Writes, 2);
    EXPECT_EQ(network.Disposals, 1);
    publisher.Service(now + 1ms);
    EXPECT_EQ(network.Disposals, 1);
    now += TopicPublisher::RetryGap;
    EXPECT_EQ(publisher.Service(now), now + TopicPublisher::RetryGap);
    EXPECT_EQ(network.Disposals, 2);
    EXPECT_EQ(publisher.Status().write_failures, 1u);
    network.DisposalResult = WriteResult::Ok;
    now += TopicPublisher::RetryGap;
    EXPECT_EQ(publisher.Service(now), std::chrono::nanoseconds::max());
    EXPECT_EQ(network.Disposals, 3);
    EXPECT_EQ(network.Writes, 2);
}

// A conversion to nanoseconds that overflows gives another result on another processor.
TEST(TopicPublisher, TheLowestRateWritesOnceAYear)
{
    TelemetryPublisher telemetry(1e-300);
    auto &[network, session, publisher, workspace, pose] = telemetry;
    publisher.SetAttached();
    pose->PostMessage();
    publisher.Service(10s);
    pose->PostMessage();
    EXPECT_EQ(publisher.Service(11s), 10s + 24h * 365);
    EXPECT_EQ(network.Writes, 1);
}

TEST(TopicPublisher, ANewerPostReplacesTheOneThatWaitsAndIsCounted)
{
    TelemetryPublisher telemetry;
    auto &[network, session, publisher, workspace, pose] = telemetry;
    pose->PostMessage();
    pose->PostMessage();
    publisher.SetAttached();  // the last post before is a value, those before it were never to be sent
    for (pose->number = 1; pose->number <= 5; ++pose->number)
    {
        pose->PostMessage();
        publisher.Fetch();
    }
    EXPECT_EQ(publisher.DueAt(10s), 10s);
    EXPECT_EQ(publisher.Status().offered, 6u);
    EXPECT_EQ(publisher.Status().replaced, 5u);
    publisher.WriteNext(10s);
    EXPECT_EQ(static_cast<const Uav::Pose &>(*publisher.Local()).number, 5u);
    EXPECT_EQ(publisher.Status().written, 1u);
    EXPECT_EQ(publisher.Status().replaced, 5u);
    EXPECT_EQ(publisher.DueAt(11s), std::chrono::nanoseconds::max());
}

TEST(TopicPublisher, AValueThatTheNetworkDidNotTakeIsReplacedByANewerOne)
{
    TelemetryPublisher telemetry;
    auto &[network, session, publisher, workspace, pose] = telemetry;
    publisher.SetAttached();
    pose->PostMessage();
    network.Result = WriteResult::TimedOut;
    publisher.Service(10s);
    EXPECT_EQ(publisher.Status().replaced, 0u);
    pose->PostMessage();
    network.Result = WriteResult::Ok;
    publisher.Service(11s);
    EXPECT_EQ(publisher.Status().offered, 2u);
    EXPECT_EQ(publisher.Status().written, 1u);
    EXPECT_EQ(publisher.Status().replaced, 1u);
}

TEST(TopicPublisher, WhatItTakesOnTheAirIsTheSampleForEachDestination)
{
    Network network;
    Session session(network);
    const PublishRule rule{.Message = "Pose", .Type = "Uav::Pose", .Qos = QosProfile::Telemetry};
    const TopicPublisher publisher(rule, Uav::Pose::IdlType(), "uav1", SourceClock(ManualClock()), session);
    const AirCost cost(1400);
    EXPECT_EQ(publisher.NextBytes(cost), 1u);  // nobody listens: it costs nothing
    network.Readers = 2;
    const std::size_t body = Uav::Pose::IdlType().SerializedSize(Uav::Pose()) - AirCost::Encapsulation;
    EXPECT_EQ(publisher.NextBytes(cost), 2 * cost.Of(body));
}

}  // namespace
}  // namespace Rabit
