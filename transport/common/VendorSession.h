#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/RejoiningBackend.h"

namespace Rabit
{

// A session of a vendor's DDS. Its writers and readers share the Core.
template <typename Core, typename Writer, typename Reader>
class VendorSession final : public BackendSession
{
public:
    VendorSession(const TransportSettings &settings, const SessionContext &context)
        : _core(std::make_shared<Core>(settings, context))
    {
    }
    ~VendorSession() override { _core->Close(); }

    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions) override
    {
        return std::make_unique<Writer>(_core, topic, qos, partitions);
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override
    {
        return std::make_unique<Reader>(_core, topic, qos, partitions, std::move(handler));
    }
    std::vector<PeerPlace> PeerPlaces() const override { return _core->PeerPlaces(); }
    std::vector<SettingsProblem> Problems() const override { return _core->Problems(); }

private:
    const std::shared_ptr<Core> _core;
};

}  // namespace Rabit
