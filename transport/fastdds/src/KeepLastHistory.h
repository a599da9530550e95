// A writer's history: the last samples, of each instance if the topic is keyed.
#pragma once

#include <fastdds/rtps/history/WriterHistory.h>

#include <chrono>
#include <cstddef>

namespace Rabit::FastDds
{

// Use it under the writer's mutex.
class KeepLastHistory final : public eprosima::fastrtps::rtps::WriterHistory
{
public:
    KeepLastHistory(int depth, bool keyed);

    // Drops the oldest samples that the new one pushes out, then adds and sends it. False if it was not
    // added; the change is still the caller's then.
    bool Add(eprosima::fastrtps::rtps::CacheChange_t &change, eprosima::fastrtps::rtps::WriteParams &params,
             std::chrono::steady_clock::time_point deadline);

private:
    void MakeRoom(const eprosima::fastrtps::rtps::InstanceHandle_t &instance);

    const std::size_t _depth;
    const bool _keyed;
};

}  // namespace Rabit::FastDds
