// A writer's history: the last samples, of each instance if the topic is keyed, and what of them is of use to
// nobody any more.
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

    // Samples that all readers have are kept for late ones, or not.
    KeepLastHistory(int depth, bool keepsForLateReaders);

    // Drops the oldest samples that the new one pushes out, then adds and sends it. If it says that its
    // instance is no more, drops all samples of the instance that all readers have. False if it was not
    // added; the change is still the caller's then.
    bool Add(Change &change, eprosima::fastrtps::rtps::WriteParams &params,
             std::chrono::steady_clock::time_point deadline);
    // All readers that are matched have this sample. Drops it, and only it, if it is of no use any more: it
    // is not kept for late readers, or it or a later one has ended the instance. May be called while it is
    // added.
    void ReceivedByAll(const Change &change);

    // Of WriterHistory; all that is dropped goes this way.
    iterator remove_change_nts(const_iterator removal, bool release = true) override;

private:
    struct HashOf
    {
        std::size_t operator()(const eprosima::fastrtps::rtps::InstanceHandle_t &instance) const;
    };

    iterator Find(std::uint64_t number);
    void Drop(const eprosima::fastrtps::rtps::InstanceHandle_t &instance, std::uint64_t number);

    const bool _keepsForLateReaders;
    std::uint64_t _receivedByAll = 0;  // the highest number of which that was said

    // All samples of a topic without a key are of the same instance.
    KeepLast<eprosima::fastrtps::rtps::InstanceHandle_t, HashOf> _kept;
};

}  // namespace Rabit::FastDds
