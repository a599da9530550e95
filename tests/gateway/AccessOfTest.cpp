#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/gateway/GatewayManager.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "SimulatedFleet.h"
#include "manager/NodeSecurity.h"

namespace Rabit
{
namespace
{

struct Opened
{
    std::vector<std::string> Written;
    std::vector<std::string> Read;
};

// Records the endpoints that are opened on the simulated network.
class NotingSession final : public TransportSession
{
public:
    NotingSession(std::unique_ptr<TransportSession> session, Opened &opened)
        : _session(std::move(session)), _opened(opened)
    {
    }
    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions) override
    {
        _opened.Written.push_back(topic.Name);
        return _session->CreateWriter(topic, qos, partitions);
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override
    {
        _opened.Read.push_back(topic.Name);
        return _session->CreateReader(topic, qos, partitions, std::move(handler));
    }
    TransportCounters Counters() const override { return _session->Counters(); }

private:
    const std::unique_ptr<TransportSession> _session;
    Opened &_opened;
};

class NotingTransport final : public Transport
{
public:
    NotingTransport(SimulatedNetwork &network, Opened &opened) : _transport(network), _opened(opened) {}
    std::string Name() const override { return _transport.Name(); }
    std::unique_ptr<TransportSession> Open(const TransportSettings &settings, PeerHandler onPeer) override
    {
        return std::make_unique<NotingSession>(_transport.Open(settings, std::move(onPeer)), _opened);
    }

private:
    SimulatedTransport _transport;
    Opened &_opened;
};

Opened WhatIsOpened(const GatewayConfig &config)
{
    Opened opened;
    SimulatedNetwork network(1);
    const auto clock = std::make_shared<ManualClock>(1.4e9, network.Now());
    RabitWorkspace workspace(clock);
    RabitSteppedReactor reactor(workspace);
    reactor.AddManager(std::make_unique<GatewayManager>(
        config, std::make_shared<NotingTransport>(network, opened), workspace, [] { return 1U; }));
    reactor.Start();
    reactor.RunFor(*clock, std::chrono::seconds(1));
    return opened;
}

GatewayConfig EverythingConfig()
{
    GatewayConfig config = AircraftConfig("uav1");
    config.Subscribe.push_back({.Message = "Pose", .Type = "Uav::Pose", .From = {"uav*", "ground"}});
    config.Send.push_back({.To = "ground"});
    config.Foreign.push_back({.Way = ForeignRule::Direction::Subscribe,
                              .Topic = "rt/odometry",
                              .Type = "Uav::Pose",
                              .Local = "Autopilot/Odometry"});
    config.Foreign.push_back({.Way = ForeignRule::Direction::Publish,
                              .Topic = "rt/setpoint",
                              .Type = "Uav::Goto",
                              .Local = "Setpoint"});
    return config;
}

TEST(AccessOf, IsWhatAGatewayOpensAndNoMore)
{
    const GatewayConfig config = EverythingConfig();
    const Opened opened = WhatIsOpened(config);
    const Keys::Access access = AccessOf(config);
    EXPECT_THAT(access.Publish, testing::UnorderedElementsAreArray(opened.Written));
    EXPECT_THAT(access.Subscribe, testing::UnorderedElementsAreArray(opened.Read));
}

TEST(AccessOf, NothingIsWrittenByAPattern)
{
    for (const std::string &topic : AccessOf(EverythingConfig()).Publish)
    {
        EXPECT_EQ(topic.find_first_of("*?"), std::string::npos) << topic;
    }
}

TEST(AccessOf, AToolReadsEverythingAndPublishesNothing)
{
    GatewayConfig config;
    config.Node = "laptop";
    config.Tool.emplace();
    const Keys::Access access = AccessOf(config);
    EXPECT_THAT(access.Publish, testing::ElementsAre("rabit/Beat", "rabit/Link"));
    EXPECT_THAT(access.Subscribe, testing::ElementsAre("*"));
}

}  // namespace
}  // namespace Rabit
