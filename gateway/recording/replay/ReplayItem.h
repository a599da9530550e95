#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "recording/mcap/McapRecords.h"

namespace Rabit::Replay
{

// As in recordings: nanoseconds since 1970 (UTC).
using Time = std::uint64_t;

// One message of a recording.
struct ReplayItem
{
    std::size_t Stream = 0;  // of the ReplayPlan
    Time LogTime = 0;
    Time PublishTime = 0;
    Mcap::Bytes Data;
};

// Where the messages of a replay come from.
class ReplaySource
{
public:
    virtual ~ReplaySource() = default;
    // From now on Next gives what was recorded at that time or later.
    virtual void Begin(Time from) = 0;
    // By log time. Nothing at the end.
    virtual std::optional<ReplayItem> Next() = 0;
    // The last one before that time of each stream that is restored, by log time.
    virtual std::vector<ReplayItem> LastBefore(Time time) = 0;
};

}  // namespace Rabit::Replay
