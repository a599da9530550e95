// A writer's history: the last samples, of each instance if the topic is keyed.
#pragma once

#include <fastdds/rtps/common/InstanceHandle.h>
#include <fastdds/rtps/history/WriterHistory.h>

#include <chrono>
#include <cstddef>

#include "KeepLast.h"

namespace Rabit::FastDds
{

// Use it under the writer's mutex.
class KeepLastHistory final : public eprosima::fastrtps::rtps::WriterHistory
{
public:
    using Change = eprosima::fastrtps::rtps::CacheChange_t;

    explicit KeepLastHistory(int depth);

    // Drops the oldest samples that the new one pushes out, then adds and sends it. False if it was not
    // added; the change is still the caller's then.
    bool Add(Change &change, eprosima::fastrtps::rtps::WriteParams &params,
             std::chrono::steady_clock::time_point deadline);
    // Drops a sample, which is freed. May be called while it is added.
    void Drop(const Change &change);

    // Of WriterHistory; all that is dropped goes this way.
    iterator remove_change_nts(const_iterator removal, bool release = true) override;

private:
    struct HashOf
    {
        std::size_t operator()(const eprosima::fastrtps::rtps::InstanceHandle_t &instance) const;
    };

    iterator Find(std::uint64_t number);

    // All samples of a topic without a key are of the same instance.
    KeepLast<eprosima::fastrtps::rtps::InstanceHandle_t, HashOf> _kept;
};

}  // namespace Rabit::FastDds
