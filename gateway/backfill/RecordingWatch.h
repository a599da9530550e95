#pragma once

#include <chrono>
#include <cstdint>

#include "recording/RecordingFiles.h"

namespace Rabit::Backfill
{

// Tells when messages of this recording may have been lost on their way to the disk. Also tells when all that
// is recorded is on it again. A pure state machine; `now` never goes back. Not thread-safe.
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
            _isDoubtful = true;
            _worksAt = now + AllIsOnDisk;
        }
        if (!_isDoubtful)
        {
            return State::Works;
        }
        if (now < _worksAt)
        {
            return State::Fails;
        }
        _isDoubtful = false;
        return State::WorksAgain;
    }

private:
    std::uint64_t _notKept = 0;
    bool _isDoubtful = false;  // it failed, and not all is on the disk again
    Duration _worksAt{0};      // unless it fails again
};

}  // namespace Rabit::Backfill
