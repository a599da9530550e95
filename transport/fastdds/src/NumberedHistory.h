#pragma once

#include <fastdds/rtps/history/ReaderHistory.h>

#include <cstddef>

namespace Rabit::FastDds
{

// The samples of a reader that wait for earlier ones of their writer, in the order of their sequence numbers.
//
// The vendor's own history is in the order of source timestamps, while the vendor's search in it ends at the
// first sample of the writer with a higher number. A sample that came late, and whose timestamp is not
// earlier than that of a later sample, was not found there: it was acknowledged, never handed over, and never
// freed. Timestamps are equal or go back where a clock was set, or where an older value is sent again.
//
// Under the reader's mutex, on the vendor's receiving threads.
class NumberedHistory : public eprosima::fastrtps::rtps::ReaderHistory
{
public:
    using ReaderHistory::ReaderHistory;
    using ReaderHistory::received_change;

    bool received_change(eprosima::fastrtps::rtps::CacheChange_t *change, std::size_t missingBefore) override;
};

}  // namespace Rabit::FastDds
