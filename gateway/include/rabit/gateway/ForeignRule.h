#pragma once

#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace Rabit
{

// A topic of programs that are no nodes of Rabit (ROS 2, PX4, any DDS program): read here as a local message
// or into a local queue, or written here from a local message. The exact rules are in
// gateway/foreign/README.md.
struct ForeignRule
{
    enum class Direction
    {
        Subscribe,
        Publish
    };
    // How Topic and Type are named on the wire.
    enum class WireNames
    {
        Plain,  // as they stand here
        Ros2    // as ROS 2 names them (names/RosNames.h)
    };
    // Selects where the samples of a topic that is read go.
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
    // Unset: a topic is read as its writers offer it, and written reliable and volatile.
    std::optional<Rabit::Reliability> Reliability{};
    std::optional<Rabit::Durability> Durability{};
    // For a topic that is written: Depth is the number of samples kept for repair and late readers, 1 to
    // 10000. MaxRate is in samples a second; 0: no limit.
    std::size_t Depth = 10;
    double MaxRate = 0.0;
    // A topic that is read becomes STALE when nothing came for this long; 0: only when its writers are gone.
    std::chrono::milliseconds StaleAfter{0};
    // For a topic that is read: true if its age counts from the samples' source time, and not from their
    // arrival. The writer's clock is then believed to show UTC.
    bool SourceTimeIsTrusted = false;
    // For Delivery::Queue: samples that may wait for room in the queue, 1 to 1,000,000, and their serialized
    // bytes, 1 to 2^40. Further samples are dropped. A sample above CapacityBytes waits only alone.
    std::size_t Capacity = 1000;
    std::size_t CapacityBytes = 16u << 20;
    int Line = 0;  // where it stands in the file, for error messages; 0: made in code
};

}  // namespace Rabit
