#pragma once

#include <rabit/mcap/McapRecords.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

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

// Gives the messages of a replay.
class ReplaySource
{
public:
    virtual ~ReplaySource() = default;
    // From now on Next gives the messages that were recorded at that time or later.
    virtual void Begin(Time from) = 0;
    // Returns the next message by log time; nothing at the end.
    virtual std::optional<ReplayItem> Next() = 0;
    // Returns the last message before that time of each stream that is restored, by log time.
    virtual std::vector<ReplayItem> LastBefore(Time time) = 0;
};

}  // namespace Rabit::Replay
