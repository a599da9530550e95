#include <rabit/fastdds/FastDdsTransport.h>

#include <memory>
#include <utility>

#include "FastDdsReader.h"
#include "FastDdsWriter.h"
#include "SessionCore.h"
#include "common/RejoiningSession.h"
#include "common/SettingsCheck.h"

namespace Rabit
{

namespace
{

class FastDdsSession final : public TransportSession
{
public:
    FastDdsSession(const TransportSettings &settings, PeerHandler onPeer)
        : _core(std::make_shared<FastDds::SessionCore>(settings, std::move(onPeer)))
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

private:
    const std::shared_ptr<FastDds::SessionCore> _core;
};

}  // namespace

std::string FastDdsTransport::Name() const
{
    return "fastdds";
}

std::unique_ptr<TransportSession> FastDdsTransport::Open(const TransportSettings &settings,
                                                         PeerHandler onPeer)
{
    return OpenRejoining(settings, std::move(onPeer),
                         [](const TransportSettings &current, PeerHandler handler)
                         { return std::make_unique<FastDdsSession>(current, std::move(handler)); });
}

}  // namespace Rabit
