#pragma once

#include <rabit/transport/Transport.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <set>

#include "KeepLastHistory.h"
#include "PayloadPool.h"
#include "SessionCore.h"
#include "Vendor.h"
#include "common/VendorWriter.h"

namespace Rabit::FastDds
{

class FastDdsWriter final : public VendorWriter<SessionCore>,
                            private WriterEvents,
                            private rtps::IReaderDataFilter
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

    void OnMatched(rtps::RTPSWriter &writer, const rtps::MatchingInfo &info) override;
    void OnReceivedByAll(const rtps::CacheChange_t &change) override;
    void on_offered_incompatible_qos(rtps::RTPSWriter *writer, dds::PolicyMask qos) override;

    // True if the reader is to get the sample being written.
    bool is_relevant(const rtps::CacheChange_t &change, const rtps::GUID_t &reader) const override;

    const std::shared_ptr<PayloadPool> _pool;
    KeepLastHistory _history;
    mutable std::mutex _mutex;
    std::set<rtps::GUID_t> _matched;                  // guarded by _mutex
    std::atomic<const Targets *> _targets = nullptr;  // during WriteTo, with the vendor's lock held
    rtps::RTPSWriter *_writer = nullptr;
};

}  // namespace Rabit::FastDds
