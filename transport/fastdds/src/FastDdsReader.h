#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <mutex>
#include <set>

#include "NumberedHistory.h"
#include "PayloadPool.h"
#include "SessionCore.h"
#include "Vendor.h"
#include "common/VendorReader.h"

namespace Rabit::FastDds
{

// Delivers each sample inside the vendor's "new change" call, out of the buffer that holds it, and drops it
// from the vendor's history at once. So the history never fills, and no sample pushes out another.
class FastDdsReader final : public VendorReader<SessionCore>, private ReaderEvents
{
public:
    FastDdsReader(std::shared_ptr<SessionCore> core, const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions, SampleHandler handler);
    ~FastDdsReader() override;

    int MatchedWriters() const override;

private:
    using Change = rtps::CacheChange_t;
    using Guid = rtps::GUID_t;

    void OnSample(rtps::RTPSReader &reader, const Change &change) override;
    void OnMatched(rtps::RTPSReader &reader, const rtps::MatchingInfo &info) override;
    void on_requested_incompatible_qos(rtps::RTPSReader *reader, dds::PolicyMask qos) override;
    void on_sample_lost(rtps::RTPSReader *reader, std::int32_t count) override;

    // These run under the gate.
    void HandOver(const Change &change);
    bool KeyFrom(const Change &change, SampleBytes bytes, KeyHash &key) const;

    const std::shared_ptr<PayloadPool> _pool;
    NumberedHistory _history;
    mutable std::mutex _mutex;
    std::set<Guid> _matched;  // guarded by _mutex
    rtps::RTPSReader *_reader = nullptr;
};

}  // namespace Rabit::FastDds
