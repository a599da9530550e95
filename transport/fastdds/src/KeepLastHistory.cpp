#include "KeepLastHistory.h"

#include <fastdds/rtps/attributes/HistoryAttributes.h>
#include <fastdds/rtps/common/CacheChange.h>

#include <algorithm>

namespace Rabit::FastDds
{

namespace rtps = eprosima::fastrtps::rtps;

namespace
{

rtps::HistoryAttributes MakeAttributes(int depth)
{
    // The buffers are our own pool's, so only the changes are reserved here.
    constexpr int MostReserved = 16;
    return {rtps::DYNAMIC_RESERVE_MEMORY_MODE, 0, std::min(depth + 1, MostReserved), 0};
}

}  // namespace

KeepLastHistory::KeepLastHistory(int depth, bool keyed)
    : WriterHistory(MakeAttributes(depth)), _depth(static_cast<std::size_t>(depth)), _keyed(keyed)
{
}

bool KeepLastHistory::Add(rtps::CacheChange_t &change, rtps::WriteParams &params,
                          std::chrono::steady_clock::time_point deadline)
{
    MakeRoom(change.instanceHandle);
    return add_change_(&change, params, deadline);
}

void KeepLastHistory::MakeRoom(const rtps::InstanceHandle_t &instance)
{
    if (!_keyed)
    {
        while (m_changes.size() >= _depth)
        {
            remove_change_nts(m_changes.begin());
        }
        return;
    }
    const auto same = [&](const rtps::CacheChange_t *kept) { return kept->instanceHandle == instance; };
    auto count = static_cast<std::size_t>(std::count_if(m_changes.begin(), m_changes.end(), same));
    for (; count >= _depth; --count)
    {
        remove_change_nts(std::find_if(m_changes.begin(), m_changes.end(), same));
    }
}

}  // namespace Rabit::FastDds
