#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "recording/RecordingFiles.h"

namespace Rabit::Backfill
{

// Tells when messages of this recording may have been lost on their way to the disk, and when all that is
// recorded is on it again. A pure state machine; `now` never goes back. Not thread-safe.
class RecordingWatch
{
public:
    using Duration = std::chrono::nanoseconds;

    // Recorded messages are on the disk after half a second, if it is quick enough.
    static constexpr Duration AllIsOnDisk = std::chrono::seconds(2);

    enum class State
    {
        Works,
        Fails,
        WorksAgain,  // told once
    };

    // The counter tells of a failure that was over before this call.
    State Look(const RecordingStatus &status, Duration now)
    {
        const bool failed = !status.Problem.empty() || status.NotKept != _notKept;
        _notKept = status.NotKept;
        if (failed)
        {
            _worksAt = now + AllIsOnDisk;
        }
        if (!_worksAt)
        {
            return State::Works;
        }
        if (now < *_worksAt)
        {
            return State::Fails;
        }
        _worksAt.reset();
        return State::WorksAgain;
    }

private:
    std::uint64_t _notKept = 0;
    std::optional<Duration> _worksAt;  // unless it fails again; empty: it works
};

}  // namespace Rabit::Backfill
