#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "recording/RecordingInbox.h"

namespace Rabit
{

// Holds back what is to be recorded, and gives it out when something happens: what came in the time before,
// and what comes until some time after. What happens meanwhile prolongs it. What has become too old, or has
// no room, is let go of: that is no loss.
//
// Pure; times are log times. Not thread-safe.
class BlackBox
{
public:
    using Time = std::uint64_t;

    BlackBox(std::chrono::nanoseconds before, std::chrono::nanoseconds after, std::size_t mostBytes);

    // Puts what is to be written in place of the items of the batch, in the order in which they came.
    void Take(RecordingInbox::Batch &batch, Time now);
    // Whether what comes now is written. Once it is not any more, what was written is complete.
    bool IsOpen() const { return _isOpen; }
    // What the last Take let go of, the oldest first: all of it came before what is to be written.
    const std::vector<RecordingItem> &LetGo() const { return _letGo; }

private:
    void LetGoOfOld(Time now);

    const Time _before;
    const Time _after;
    const std::size_t _mostBytes;
    std::deque<RecordingItem> _kept;
    std::size_t _bytes = 0;
    std::vector<RecordingItem> _letGo;
    Time _until = 0;
    bool _isOpen = false;
};

}  // namespace Rabit
