#pragma once

#include <cstddef>

#include "Vendor.h"

namespace Rabit::FastDds
{

// A reader's samples that wait for earlier ones of their writer, in the order of their sequence numbers.
//
// The vendor's own history is in the order of source timestamps, but its search ends at the first sample of
// the writer with a higher number. So it did not find a late sample whose timestamp was not earlier than that
// of a later sample. Such a sample was acknowledged, never delivered, and never freed. Timestamps are equal
// or go back where a clock was set, or where an older value is sent again.
//
// Guarded by the reader's mutex; used on the vendor's receiving threads.
class NumberedHistory : public rtps::ReaderHistory
{
public:
    using ReaderHistory::ReaderHistory;
    using ReaderHistory::received_change;

    bool received_change(rtps::CacheChange_t *change, std::size_t missingBefore) override;
};

}  // namespace Rabit::FastDds
