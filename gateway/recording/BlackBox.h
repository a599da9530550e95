#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "recording/RecordingInbox.h"

namespace Rabit
{

// Holds back items, and gives them out at an event: those of the time `before` it, and those until the time
// `after` it. Further events prolong that. Items that are too old, or have no room, are dropped; that does
// not count as a loss.
//
// Pure; times are log times. Not thread-safe.
class BlackBox
{
public:
    using Time = std::uint64_t;

    BlackBox(std::chrono::nanoseconds before, std::chrono::nanoseconds after, std::size_t mostBytes);

    // Replaces the items of the batch by those that are to be written now, in the order in which they came.
    void Take(RecordingInbox::Batch &batch, Time now);
    // True while items are written as they come. When it turns false, the recording of the event is
    // complete.
    bool IsOpen() const { return _isOpen; }
    // The items that the last Take dropped, the oldest first. All came before those that it gave out.
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
