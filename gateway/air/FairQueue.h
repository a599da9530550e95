#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "air/AirStream.h"

namespace Rabit
{

// The streams of one class that have something to send, in the order of their turns (start-time fair
// queueing, Goyal, Vin and Cheng 1996). While two streams have something to send, their bytes are in
// proportion to their weights, to within a datagram each. An idle stream saves up no share, and is next when
// it comes back.
//
// A heap of streams that know their places in it: O(log n), and no allocation once it has been as large.
class FairQueue
{
public:
    bool IsEmpty() const { return _heap.empty(); }
    // The stream whose turn it is. The queue must not be empty.
    AirStream &First() const { return *_heap.front(); }

    // True if the share of the stream allows it to send right behind the last one. While others that have
    // just sent have nothing, it could get ahead of them otherwise.
    bool MayFollow(const AirStream &stream) const { return stream.Tag <= _end; }

    void Add(AirStream &stream);
    void Remove(AirStream &stream);
    // The stream has sent `bytes` bytes; it need not be in the queue.
    void Charge(AirStream &stream, std::size_t bytes);

private:
    static bool IsBefore(const AirStream &a, const AirStream &b);
    void Place(std::size_t at, AirStream &stream);
    void Rise(std::size_t at);
    void Sink(std::size_t at);

    std::vector<AirStream *> _heap;
    double _now = 0.0;  // virtual time: the tag of the stream that sent last
    double _end = 0.0;  // virtual time at which that stream's next datagram begins
    std::uint64_t _arrivals = 0;
};

}  // namespace Rabit
