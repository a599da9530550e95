#pragma once

#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace Rabit
{

// A topic of programs that are no nodes of Rabit (ROS 2, PX4, any DDS program): read here as a local message
// or into a local queue, or written here from a local message. What exactly holds is in
// gateway/foreign/README.md.
struct ForeignRule
{
    enum class Direction
    {
        Subscribe,
        Publish
    };
    // How Topic and Type are called on the wire.
    enum class WireNames
    {
        Plain,  // as they stand here
        Ros2    // as ROS 2 calls them (names/RosNames.h)
    };
    // Of one that is read: what becomes of its samples.
    enum class Delivery
    {
        Latest,  // the newest is the message Local
        Queue    // each and every one goes into the queue Local
    };

    Direction Way = Direction::Subscribe;
    std::string Topic;
    std::string Type;   // the IDL name, as this process knows it
    std::string Local;  // message or queue
    WireNames Names = WireNames::Plain;
    Delivery Each = Delivery::Latest;
    // Unset: of one that is read as the writers offer it, of one that is written reliable and volatile.
    std::optional<Rabit::Reliability> Reliability{};
    std::optional<Rabit::Durability> Durability{};
    // Of one that is written: samples that are kept for repair and late readers, 1 to 10000; samples a second
    // at most, 0: no limit.
    std::size_t Depth = 10;
    double MaxRate = 0.0;
    // Of one that is read: STALE when nothing came for so long; 0: only when its writers are gone.
    std::chrono::milliseconds StaleAfter{0};
    // Of one that is read: whether its age counts from the time that the writer gives its samples, whose
    // clock is then believed to show UTC as ours does, and not from their arrival.
    bool SourceTimeIsTrusted = false;
    // Into a queue: samples that may wait for room in it, 1 to 1,000,000; what comes then is dropped.
    std::size_t Capacity = 1000;
    int Line = 0;  // where it stands in the file, for error messages; 0: made in code
};

}  // namespace Rabit
