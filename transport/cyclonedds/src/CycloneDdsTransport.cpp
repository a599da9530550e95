#include <rabit/cyclonedds/CycloneDdsTransport.h>

#include <utility>

#include "CycloneReader.h"
#include "CycloneWriter.h"
#include "SessionCore.h"
#include "common/RejoiningSession.h"
#include "common/SettingsCheck.h"

namespace Rabit
{

namespace
{

using namespace Cyclone;

class CycloneSession final : public TransportSession
{
public:
    CycloneSession(const TransportSettings &settings, PeerHandler onPeer)
        : _core(std::make_shared<SessionCore>(settings, std::move(onPeer)))
    {
    }
    ~CycloneSession() override { _core->Close(); }

    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions) override
    {
        CheckQos(topic, qos);
        return std::make_unique<CycloneWriter>(_core, topic, qos, partitions);
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override
    {
        CheckQos(topic, qos);
        return std::make_unique<CycloneReader>(_core, topic, qos, partitions, std::move(handler));
    }
    TransportCounters Counters() const override { return _core->Log()->Read(); }

private:
    const std::shared_ptr<SessionCore> _core;
};

}  // namespace

std::string CycloneDdsTransport::Name() const
{
    return "cyclonedds";
}

std::unique_ptr<TransportSession> CycloneDdsTransport::Open(const TransportSettings &settings,
                                                            PeerHandler onPeer)
{
    return OpenRejoining(settings, std::move(onPeer),
                         [](const TransportSettings &current, PeerHandler handler)
                         { return std::make_unique<CycloneSession>(current, std::move(handler)); });
}

}  // namespace Rabit
