#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>
#include <vector>

#include "Entity.h"
#include "SessionCore.h"
#include "common/HeldDatagrams.h"

struct ddsi_sertype;

namespace Rabit::Cyclone
{

// Encodes each sample into the object that the vendor sends and keeps for repair.
class CycloneWriter final : public TransportWriter
{
public:
    CycloneWriter(std::shared_ptr<SessionCore> core, const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions);

    WriteResult Write(const SampleEncoder &sample, std::int64_t sourceTime) override;
    WriteResult WriteHeld(const SampleEncoder &sample, std::int64_t sourceTime) override;
    std::size_t HeldBytes() const override { return _held.NextBytes(); }
    void SendHeld() override { _held.SendNext(); }
    WriteResult WriteTo(const std::string &node, const SampleEncoder &sample,
                        std::int64_t sourceTime) override;
    WriteResult Dispose(const SampleEncoder &sample, std::int64_t sourceTime) override;
    int MatchedReaders() const override;
    int Destinations() const override;

private:
    ddsi_guid_t VendorGuid() const;
    WriteResult Fail(const char *why, WriteResult result = WriteResult::Failed);
    WriteResult Send(const SampleEncoder &encoder, std::int64_t sourceTime, bool dispose);

    const std::shared_ptr<SessionCore> _core;
    const TopicDescription _topic;
    const TopicQos _qos;
    const TopicRegistry::Use _use;
    HeldDatagrams _held;
    const ddsi_sertype *_type = nullptr;
    const Entity _entityTopic;
    Entity _writer;  // last member, so that no listener runs when the others are destroyed
};

}  // namespace Rabit::Cyclone
