// A backend that throws while a gateway opens its endpoints.
#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

// State that the sessions and endpoints of one backend share.
struct Endpoints
{
    int Alive = 0;
    int Made = 0;
    int FailAt = 0;          // 1: the first one fails
    int AliveAtTheEnd = -1;  // when the session was destroyed; -1: it was not
    bool IsOutOfMemory = false;

    void MakeOne()
    {
        if (++Made == FailAt)
        {
            if (IsOutOfMemory)
            {
                throw std::bad_alloc();
            }
            throw std::logic_error("the backend has a fault");
        }
    }
};

class CountedWriter final : public TransportWriter
{
public:
    CountedWriter(Endpoints &endpoints, std::unique_ptr<TransportWriter> inner)
        : _endpoints(endpoints), _inner(std::move(inner))
    {
        ++_endpoints.Alive;
    }
    ~CountedWriter() override { --_endpoints.Alive; }

    WriteResult Write(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return _inner->Write(sample, sourceTime);
    }
    WriteResult WriteTo(const std::string &node, const SampleEncoder &sample,
                        std::int64_t sourceTime) override
    {
        return _inner->WriteTo(node, sample, sourceTime);
    }
    WriteResult Dispose(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return _inner->Dispose(sample, sourceTime);
    }
    int MatchedReaders() const override { return _inner->MatchedReaders(); }
    int Destinations() const override { return _inner->Destinations(); }

private:
    Endpoints &_endpoints;
    const std::unique_ptr<TransportWriter> _inner;
};

class CountedReader final : public TransportReader
{
public:
    CountedReader(Endpoints &endpoints, std::unique_ptr<TransportReader> inner)
        : _endpoints(endpoints), _inner(std::move(inner))
    {
        ++_endpoints.Alive;
    }
    ~CountedReader() override { --_endpoints.Alive; }
    int MatchedWriters() const override { return _inner->MatchedWriters(); }

private:
    Endpoints &_endpoints;
    const std::unique_ptr<TransportReader> _inner;
};

class CountedSession final : public TransportSession
{
public:
    CountedSession(Endpoints &endpoints, std::unique_ptr<TransportSession> inner)
        : _endpoints(endpoints), _inner(std::move(inner))
    {
    }
    ~CountedSession() override { _endpoints.AliveAtTheEnd = _endpoints.Alive; }

    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions) override
    {
        _endpoints.MakeOne();
        return std::make_unique<CountedWriter>(_endpoints, _inner->CreateWriter(topic, qos, partitions));
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override
    {
        _endpoints.MakeOne();
        return std::make_unique<CountedReader>(
            _endpoints, _inner->CreateReader(topic, qos, partitions, std::move(handler)));
    }
    TransportCounters Counters() const override { return _inner->Counters(); }

private:
    Endpoints &_endpoints;
    const std::unique_ptr<TransportSession> _inner;
};

class FaultyTransport final : public Transport
{
public:
    FaultyTransport(SimulatedNetwork &network, Endpoints &endpoints) : _inner(network), _endpoints(endpoints)
    {
    }
    std::string Name() const override { return _inner.Name(); }
    std::unique_ptr<TransportSession> Open(const TransportSettings &settings, PeerHandler onPeer) override
    {
        _endpoints.MakeOne();
        return std::make_unique<CountedSession>(_endpoints, _inner.Open(settings, std::move(onPeer)));
    }

private:
    SimulatedTransport _inner;
    Endpoints &_endpoints;
};

GatewayConfig ConfigWithAllKindsOfEndpoints()
{
    GatewayConfig config = AircraftConfig("uav1");
    const GatewayConfig ground = GroundConfig();
    config.Subscribe = ground.Subscribe;
    config.Send.push_back({.To = "ground"});
    config.Foreign.push_back({.Way = ForeignRule::Direction::Publish,
                              .Topic = "rt/pose",
                              .Type = "Uav::Pose",
                              .Local = "Pose",
                              .Reliability = Reliability::Reliable,
                              .Durability = Durability::Volatile});
    config.Foreign.push_back({.Way = ForeignRule::Direction::Subscribe,
                              .Topic = "rt/other",
                              .Type = "Uav::Pose",
                              .Local = "Other",
                              .Reliability = Reliability::Reliable,
                              .Durability = Durability::Volatile});
    return config;
}

class OpenFailureTest : public ::testing::TestWithParam<bool>
{
};

TEST_P(OpenFailureTest, ASessionOutlivesItsEndpointsWhicheverOfThemTheBackendFailsToMake)
{
    SimulatedNetwork network(1);
    for (Endpoints endpoints{.FailAt = 1, .IsOutOfMemory = GetParam()};;
         endpoints = {.FailAt = endpoints.FailAt + 1, .IsOutOfMemory = GetParam()})
    {
        RabitWorkspace workspace;
        bool failed = false;
        try
        {
            const GatewayManager gateway(ConfigWithAllKindsOfEndpoints(),
                                         std::make_shared<FaultyTransport>(network, endpoints), workspace);
        }
        catch (const std::exception &)
        {
            failed = true;
        }
        EXPECT_LE(endpoints.AliveAtTheEnd, 0) << "after " << endpoints.Made;
        EXPECT_EQ(endpoints.Alive, 0) << "after " << endpoints.Made;
        EXPECT_TRUE(workspace.GetListOfQueueForwarders().empty()) << "after " << endpoints.Made;
        if (!failed)
        {
            EXPECT_GT(endpoints.Made, 10) << "all kinds of endpoints were tried";
            break;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Reasons, OpenFailureTest, ::testing::Bool());

}  // namespace
}  // namespace Rabit
