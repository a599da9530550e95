#include "air/FairQueue.h"

#include <algorithm>

namespace Rabit
{

bool FairQueue::IsBefore(const AirStream &a, const AirStream &b)
{
    return a.Tag != b.Tag ? a.Tag < b.Tag : a.Arrived < b.Arrived;
}

void FairQueue::Place(std::size_t at, AirStream &stream)
{
    _heap[at] = &stream;
    stream.HeapPlace = at;
}

void FairQueue::Rise(std::size_t at)
{
    AirStream &stream = *_heap[at];
    while (at > 0 && IsBefore(stream, *_heap[(at - 1) / 2]))
    {
        Place(at, *_heap[(at - 1) / 2]);
        at = (at - 1) / 2;
    }
    Place(at, stream);
}

void FairQueue::Sink(std::size_t at)
{
    AirStream &stream = *_heap[at];
    for (std::size_t child = 2 * at + 1; child < _heap.size(); child = 2 * at + 1)
    {
        if (child + 1 < _heap.size() && IsBefore(*_heap[child + 1], *_heap[child]))
        {
            ++child;
        }
        if (!IsBefore(*_heap[child], stream))
        {
            break;
        }
        Place(at, *_heap[child]);
        at = child;
    }
    Place(at, stream);
}

void FairQueue::Add(AirStream &stream)
{
    stream.Arrived = ++_arrivals;
    _heap.push_back(&stream);
    Rise(_heap.size() - 1);
}

void FairQueue::Remove(AirStream &stream)
{
    const std::size_t at = stream.HeapPlace;
    AirStream &last = *_heap.back();
    _heap.pop_back();
    stream.HeapPlace = AirStream::NotWaiting;
    if (&last != &stream)
    {
        Place(at, last);
        Rise(at);
        Sink(last.HeapPlace);
    }
}

void FairQueue::Charge(AirStream &stream, std::size_t bytes)
{
    stream.Tag = std::max(stream.Tag, _now);
    _now = stream.Tag;
    stream.Tag += static_cast<double>(bytes) / stream.Weight;
    _end = stream.Tag;
    if (stream.HeapPlace != AirStream::NotWaiting)
    {
        Sink(stream.HeapPlace);
    }
}

}  // namespace Rabit
