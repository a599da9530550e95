#include <rabit/fastdds/FastDdsTransport.h>

#include <memory>
#include <utility>

#include "FastDdsReader.h"
#include "FastDdsWriter.h"
#include "ParticipantSettings.h"
#include "SessionCore.h"
#include "common/RejoiningBackend.h"
#include "common/RejoiningSession.h"
#include "common/SettingsCheck.h"

namespace Rabit
{

namespace
{

class FastDdsSession final : public BackendSession
{
public:
    FastDdsSession(const TransportSettings &settings, PeerHandler onPeer,
                   std::shared_ptr<DiscoveryTurns> turns)
        : _core(std::make_shared<FastDds::SessionCore>(settings, std::move(onPeer), std::move(turns)))
    {
    }
    ~FastDdsSession() override { _core->Close(); }

    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions) override
    {
        CheckQos(topic, qos);
        return std::make_unique<FastDds::FastDdsWriter>(_core, topic, qos, partitions);
    }

    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override
    {
        CheckQos(topic, qos);
        return std::make_unique<FastDds::FastDdsReader>(_core, topic, qos, partitions, std::move(handler));
    }

    TransportCounters Counters() const override { return _core->Log()->Read(); }

    std::vector<RemoteEndpoint> RemoteEndpointsOn(const std::string &topic) const override
    {
        return _core->Topics().RemoteOn(topic);
    }
    std::vector<std::string> RemoteTopics() const override { return _core->Topics().RemoteTopics(); }
    std::vector<PeerPlace> PeerPlaces() const override { return _core->PeerPlaces(); }

private:
    const std::shared_ptr<FastDds::SessionCore> _core;
};

class FastDdsBackend final : public RejoiningBackend
{
public:
    std::unique_ptr<BackendSession> Open(const TransportSettings &settings, PeerHandler onPeer,
                                         std::shared_ptr<DiscoveryTurns> turns) override
    {
        return std::make_unique<FastDdsSession>(settings, std::move(onPeer), std::move(turns));
    }
    void CheckConfig(const TransportSettings &settings) const override
    {
        FastDds::HasOwnTransports(settings.BackendConfig);
    }
    bool HasOwnNetworks(const TransportSettings &settings) const override
    {
        return FastDds::HasOwnTransports(settings.BackendConfig);
    }
    bool FindsNetworks() const override { return true; }
    bool IsMisledByDuplicates() const override { return false; }
};

}  // namespace

std::string FastDdsTransport::Name() const
{
    return "fastdds";
}

std::unique_ptr<TransportSession> FastDdsTransport::Open(const TransportSettings &settings,
                                                         PeerHandler onPeer)
{
    return OpenRejoining(settings, std::move(onPeer), std::make_shared<FastDdsBackend>());
}

std::vector<SettingsProblem> FastDdsTransport::Check(const TransportSettings &settings) const
{
    return CheckRejoining(settings, FastDdsBackend());
}

}  // namespace Rabit
