#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "air/AirStream.h"

namespace Rabit
{

// The streams of one class that have something to send, and whose turn it is: bytes in proportion to weights
// over any time in which two streams have something to send, give or take a datagram each (start-time fair
// queueing, Goyal, Vin and Cheng 1996). A stream that had nothing to send gains no right by it, and is next
// when it comes back.
//
// A heap of streams that know their places in it: O(log n), and no allocation once it has been as large.
class FairQueue
{
public:
    bool IsEmpty() const { return _heap.empty(); }
    // Whose turn it is. Not of an empty queue.
    AirStream &First() const { return *_heap.front(); }

    void Add(AirStream &stream);
    void Remove(AirStream &stream);
    // It has sent so many bytes; whether it is in the queue or not.
    void Charge(AirStream &stream, std::size_t bytes);

private:
    static bool IsBefore(const AirStream &a, const AirStream &b);
    void Place(std::size_t at, AirStream &stream);
    void Rise(std::size_t at);
    void Sink(std::size_t at);

    std::vector<AirStream *> _heap;
    double _now = 0.0;  // virtual time: the tag of what was sent last
    std::uint64_t _arrivals = 0;
};

}  // namespace Rabit
