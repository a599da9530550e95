#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/RejoiningBackend.h"
#include "common/SettingsCheck.h"

namespace Rabit
{

// A session of a vendor's DDS. Its writers and readers share the Core.
template <typename Core, typename Writer, typename Reader>
class VendorSession final : public BackendSession
{
public:
    VendorSession(const TransportSettings &settings, PeerHandler onPeer,
                  std::shared_ptr<DiscoveryTurns> turns)
        : _core(std::make_shared<Core>(settings, std::move(onPeer), std::move(turns)))
    {
    }
    ~VendorSession() override { _core->Close(); }

    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions) override
    {
        CheckQos(topic, qos);
        return std::make_unique<Writer>(_core, topic, qos, partitions);
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override
    {
        CheckQos(topic, qos);
        return std::make_unique<Reader>(_core, topic, qos, partitions, std::move(handler));
    }
    TransportCounters Counters() const override { return _core->Log()->Read(); }
    std::vector<RemoteEndpoint> RemoteEndpointsOn(const std::string &topic) const override
    {
        return _core->Topics().RemoteOn(topic);
    }
    std::vector<std::string> RemoteTopics() const override { return _core->Topics().RemoteTopics(); }
    std::vector<PeerPlace> PeerPlaces() const override { return _core->PeerPlaces(); }

private:
    const std::shared_ptr<Core> _core;
};

}  // namespace Rabit
