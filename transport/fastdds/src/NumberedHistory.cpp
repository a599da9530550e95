#include "NumberedHistory.h"

#include <algorithm>
#include <mutex>

namespace Rabit::FastDds
{

bool NumberedHistory::received_change(rtps::CacheChange_t *change, std::size_t)
{
    const std::lock_guard lock(*getMutex());
    const auto isLater = [change](const auto *other)
    { return other->writerGUID == change->writerGUID && other->sequenceNumber > change->sequenceNumber; };
    m_changes.insert(std::find_if(m_changes.begin(), m_changes.end(), isLater), change);
    return true;
}

}  // namespace Rabit::FastDds
