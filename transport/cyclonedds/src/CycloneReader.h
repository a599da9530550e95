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
#include "common/HandlerGate.h"
#include "common/InstanceTable.h"

namespace Rabit::Cyclone
{

// Stands where the vendor keeps a reader's history: each sample is handed over on the vendor's receiving
// thread, out of the object that it arrived in, and none is kept. So there is no queue, no further thread and
// no history that could fill.
//
// Lifetime: dds_delete returns when no thread of the vendor's uses the reader or its cache any more (it waits
// until its garbage collector has seen each of its threads leave), and the vendor's entity is the first
// member to go.
class CycloneReader final : public TransportReader
{
public:
    CycloneReader(std::shared_ptr<SessionCore> core, const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions, SampleHandler handler);
    ~CycloneReader() override;

    int MatchedWriters() const override;

private:
    struct Cache
    {
        dds_rhc Base;  // the first, as the vendor demands
        CycloneReader *Owner;
    };

    static const dds_rhc_ops &CacheOps();
    static CycloneReader &OwnerOf(ddsi_rhc *cache);

    // These run under the gate.
    void HandOver(const OpaqueSample &sample, const WriterId &writer);
    // So that nothing is lost with a sample that is lost.
    void Follow(const WriterId &writer);
    void HandOverEnd(const OpaqueSample &sample, SampleInfo &info);
    void WriterGone(const WriterId &writer);
    SampleInfo InfoFor(const WriterId &writer);

    const std::shared_ptr<SessionCore> _core;
    const TopicDescription _topic;
    const TopicRegistry::Use _use;
    const SampleHandler _handler;
    HandlerGate _gate;
    InstanceTable _instances;                      // under the gate
    std::set<WriterId> _inStep;                    // with this reader; under the gate
    WriterId _lastWriter{};                        // under the gate
    std::shared_ptr<const PeerSession> _lastNode;  // of _lastWriter; under the gate
    Cache _cache{};
    const ddsi_sertype *_type = nullptr;
    const Entity _entityTopic;
    Entity _reader;  // the last, see above
};

}  // namespace Rabit::Cyclone
