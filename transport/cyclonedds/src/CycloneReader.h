#pragma once

#include <dds/dds.h>
#include <dds/ddsc/dds_rhc.h>
#include <dds/ddsi/ddsi_rhc.h>
#include <rabit/transport/Transport.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "Entity.h"
#include "OpaqueType.h"
#include "SessionCore.h"
#include "common/VendorReader.h"

namespace Rabit::Cyclone
{

// Takes the place of the vendor's history of a reader. It delivers each sample on the vendor's receiving
// thread, out of the object in which it arrived, and keeps none: no queue, no further thread and no history
// that could fill.
//
// Lifetime: dds_delete returns when no thread of the vendor's uses the reader or its cache any more: it waits
// until its garbage collector has seen each of its threads leave. So the vendor's entity is the first member
// to be destroyed.
class CycloneReader final : public VendorReader<SessionCore>
{
public:
    CycloneReader(std::shared_ptr<SessionCore> core, const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions, SampleHandler handler);
    ~CycloneReader() override;

    int MatchedWriters() const override;

private:
    struct Cache
    {
        dds_rhc Base;  // first, as the vendor requires
        CycloneReader *Owner;
    };

    static const dds_rhc_ops &CacheOps();
    static CycloneReader &OwnerOf(ddsi_rhc *cache);

    // These run with the gate held.
    void HandOver(const OpaqueSample &sample, const WriterId &writer);
    // Keeps the reader in step with the writer, so that a lost sample costs no other one.
    void Follow(const WriterId &writer);

    std::set<WriterId> _inStep;  // with this reader; under the gate
    Cache _cache{};
    const ddsi_sertype *_type = nullptr;
    const Entity _entityTopic;
    const KeptInstance _instance;
    Entity _reader;  // last member, see above
};

}  // namespace Rabit::Cyclone
