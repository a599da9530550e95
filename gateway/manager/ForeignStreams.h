#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <vector>

#include "air/AirSchedule.h"
#include "foreign/ForeignPublisher.h"

namespace Rabit
{

// The foreign topics that this node writes as streams of the schedule, each one of class foreign. Gateway's
// thread only.
class ForeignStreams
{
public:
    using Duration = std::chrono::nanoseconds;

    // `publishers`: null on a path without foreign topics. References must outlive the object.
    ForeignStreams(std::deque<ForeignPublisher> *publishers, AirSchedule &schedule)
        : _publishers(publishers), _schedule(schedule)
    {
    }

    // Call once all publishers exist.
    void Open();
    // The publishers may end.
    void Close() { _streams.clear(); }

    // Tells the schedule which topics have a sample to send now.
    void Look(Duration now);
    // When the next sample is due that is not yet; Duration::max(): there is none.
    Duration NextDue(Duration now) const;
    // Sends one datagram of the chosen stream. Returns false if it is no stream of this object.
    bool Send(StreamId id, Duration now);
    // Sends all that is due, without the schedule. Returns when to call again at the latest.
    Duration SendAll(Duration now);

    // Bytes on the air of all samples sent.
    std::uint64_t SentBytes() const;

private:
    std::deque<ForeignPublisher> *const _publishers;
    AirSchedule &_schedule;
    std::vector<StreamId> _streams;  // in the order of the publishers
};

}  // namespace Rabit
