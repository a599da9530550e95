#pragma once

#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/MatchingInfo.h>
#include <fastdds/rtps/reader/ReaderListener.h>
#include <rabit/transport/Transport.h>

#include <memory>
#include <mutex>
#include <set>

#include "NumberedHistory.h"
#include "PayloadPool.h"
#include "SessionCore.h"
#include "common/VendorReader.h"

namespace Rabit::FastDds
{

// Delivers each sample inside the vendor's "new change" call, out of the buffer that holds it, and drops it
// from the vendor's history at once. So the history never fills, and no sample pushes out another.
class FastDdsReader final : public VendorReader<SessionCore>, private eprosima::fastrtps::rtps::ReaderListener
{
public:
    FastDdsReader(std::shared_ptr<SessionCore> core, const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions, SampleHandler handler);
    ~FastDdsReader() override;

    int MatchedWriters() const override;

private:
    using Change = eprosima::fastrtps::rtps::CacheChange_t;
    using Guid = eprosima::fastrtps::rtps::GUID_t;

    void onNewCacheChangeAdded(eprosima::fastrtps::rtps::RTPSReader *reader,
                               const Change *const change) override;
    void onReaderMatched(eprosima::fastrtps::rtps::RTPSReader *reader,
                         eprosima::fastrtps::rtps::MatchingInfo &info) override;
    void on_requested_incompatible_qos(eprosima::fastrtps::rtps::RTPSReader *reader,
                                       eprosima::fastdds::dds::PolicyMask qos) override;
    void on_sample_lost(eprosima::fastrtps::rtps::RTPSReader *reader, std::int32_t count) override;

    // These run under the gate.
    void HandOver(const Change &change);
    bool KeyFrom(const Change &change, SampleBytes bytes, KeyHash &key) const;

    const std::shared_ptr<PayloadPool> _pool;
    NumberedHistory _history;
    mutable std::mutex _mutex;
    std::set<Guid> _matched;  // guarded by _mutex
    eprosima::fastrtps::rtps::RTPSReader *_reader = nullptr;
};

}  // namespace Rabit::FastDds
