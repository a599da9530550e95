#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <memory>

#include "NetworkCore.h"

namespace Rabit::Simulated
{

class SimulatedSession final : public TransportSession, private DiscoveryTurns::Exchange
{
public:
    SimulatedSession(std::shared_ptr<NetworkCore> core, const TransportSettings &settings,
                     PeerHandler onPeer);
    ~SimulatedSession() override;

    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions) override;
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override;
    TransportCounters Counters() const override;
    DiscoveryTurns *Discovery() override { return &_participant->Turns; }
    bool BeginTurn(std::size_t mostBytes) override { return _core->BeginTurn(*_participant, mostBytes); }
    TurnDestinations TakeTurnDestinations() override { return _core->TakeTurnDestinations(*_participant); }
    void EndTurn() override { _core->EndTurn(*_participant); }
    std::vector<RemoteEndpoint> RemoteEndpointsOn(const std::string &topic) const override
    {
        return _participant->Topics.RemoteOn(topic);
    }
    std::vector<std::string> RemoteTopics() const override { return _participant->Topics.RemoteTopics(); }

private:
    std::size_t NextBytes() override { return _core->NextDiscoveryBytes(*_participant); }
    void SendNext() override { _core->SendNextDiscovery(_participant); }
    std::chrono::nanoseconds QueueingDelay() const override { return _core->CardDelay(*_participant); }

    const std::shared_ptr<NetworkCore> _core;
    const ParticipantPtr _participant;
};

}  // namespace Rabit::Simulated
