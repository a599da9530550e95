#pragma once

#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/MatchingInfo.h>
#include <fastdds/rtps/writer/WriterListener.h>
#include <rabit/transport/Transport.h>
#include <fastdds/rtps/interfaces/IReaderDataFilter.hpp>

#include <atomic>
#include <memory>
#include <mutex>
#include <set>

#include "KeepLastHistory.h"
#include "PayloadPool.h"
#include "SessionCore.h"
#include "common/VendorWriter.h"

namespace Rabit::FastDds
{

class FastDdsWriter final : public VendorWriter<SessionCore>,
                            private eprosima::fastrtps::rtps::WriterListener,
                            private eprosima::fastdds::rtps::IReaderDataFilter
{
public:
    FastDdsWriter(std::shared_ptr<SessionCore> core, const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions);
    ~FastDdsWriter() override;

    int MatchedReaders() const override;
    int Destinations() const override;

private:
    using Targets = std::vector<Rtps::GuidPrefix>;
    WriteResult Send(const SampleEncoder &sample, std::int64_t sourceTime, bool dispose) override
    {
        return Send(sample, sourceTime, dispose, nullptr);
    }
    WriteResult SendTo(const std::string &node, const SampleEncoder &sample,
                       std::int64_t sourceTime) override;
    // Sends to the participants in `to`; nullptr: to all.
    WriteResult Send(const SampleEncoder &sample, std::int64_t sourceTime, bool dispose, const Targets *to);
    WriteResult SendEncoded(PayloadPool::Buffer buffer, std::uint32_t size, const KeyHash &key,
                            std::int64_t sourceTime, bool dispose, const Targets *to);

    void onWriterMatched(eprosima::fastrtps::rtps::RTPSWriter *writer,
                         eprosima::fastrtps::rtps::MatchingInfo &info) override;
    void onWriterChangeReceivedByAll(eprosima::fastrtps::rtps::RTPSWriter *writer,
                                     eprosima::fastrtps::rtps::CacheChange_t *change) override;
    void on_offered_incompatible_qos(eprosima::fastrtps::rtps::RTPSWriter *writer,
                                     eprosima::fastdds::dds::PolicyMask qos) override;

    // True if the reader is to get the sample being written.
    bool is_relevant(const eprosima::fastrtps::rtps::CacheChange_t &change,
                     const eprosima::fastrtps::rtps::GUID_t &reader) const override;

    const std::shared_ptr<PayloadPool> _pool;
    KeepLastHistory _history;
    mutable std::mutex _mutex;
    std::set<eprosima::fastrtps::rtps::GUID_t> _matched;  // guarded by _mutex
    std::atomic<const Targets *> _targets = nullptr;      // during WriteTo, with the vendor's lock held
    eprosima::fastrtps::rtps::RTPSWriter *_writer = nullptr;
};

}  // namespace Rabit::FastDds
