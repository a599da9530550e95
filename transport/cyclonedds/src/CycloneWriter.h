#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>
#include <vector>

#include "Entity.h"
#include "OpaqueType.h"
#include "SessionCore.h"
#include "common/VendorWriter.h"

struct ddsi_sertype;

namespace Rabit::Cyclone
{

// Encodes each sample into the object that the vendor sends and keeps for repair.
class CycloneWriter final : public VendorWriter<SessionCore>
{
public:
    CycloneWriter(std::shared_ptr<SessionCore> core, const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions);

    int MatchedReaders() const override;
    int Destinations() const override;

private:
    ddsi_guid_t VendorGuid() const;
    WriteResult Send(const SampleEncoder &encoder, std::int64_t sourceTime, bool dispose) override;
    WriteResult SendTo(const std::string &node, const SampleEncoder &sample,
                       std::int64_t sourceTime) override;

    const ddsi_sertype *_type = nullptr;
    const Entity _entityTopic;
    const KeptInstance _instance;
    Entity _writer;  // last member, so that no listener runs when the others are destroyed
};

}  // namespace Rabit::Cyclone
