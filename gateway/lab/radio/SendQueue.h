#pragma once

#include "Frame.h"
#include "NodeCounters.h"

#include <cstddef>
#include <deque>

namespace Rabit::Radio
{

// The buffer of one node's radio: first in, first out. A frame that does not fit is dropped (drop-tail). An
// empty queue takes one frame of any size.
class SendQueue
{
public:
    struct Waiting
    {
        Time Since;
        FramePointer What;
    };

    explicit SendQueue(std::size_t limit) : _limit(limit) {}

    // Returns false if the frame was dropped.
    bool Push(Time now, FramePointer frame)
    {
        if (!_frames.empty() && _bytes + frame->size() > _limit)
        {
            return false;
        }
        _bytes += frame->size();
        _frames.push_back({now, std::move(frame)});
        return true;
    }

    // The queue must not be empty.
    Waiting Pop()
    {
        Waiting first = std::move(_frames.front());
        _frames.pop_front();
        _bytes -= first.What->size();
        return first;
    }

    bool IsEmpty() const { return _frames.empty(); }
    std::size_t Bytes() const { return _bytes; }
    // Returns how long the first frame has waited.
    Time Age(Time now) const { return _frames.empty() ? Time{0} : now - _frames.front().Since; }
    // Frames that wait stay, even if they exceed the new limit.
    void SetLimit(std::size_t bytes) { _limit = bytes; }

private:
    std::size_t _limit;
    std::size_t _bytes = 0;
    std::deque<Waiting> _frames;
};

}  // namespace Rabit::Radio
