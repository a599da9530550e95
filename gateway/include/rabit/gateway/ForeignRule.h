#pragma once

#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace Rabit
{

// A topic of programs that are no nodes of Rabit (ROS 2, PX4, any DDS program): read here as a local message
// or into a local queue, or written here from a local message or queue. The exact rules are in
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
    // Selects what Local is.
    enum class Delivery
    {
        Latest,  // a message: the newest sample that was read, or the newest value, which is written
        Queue  // a queue: each and every sample that was read goes into it, or each message for it is written
    };

    static constexpr std::size_t DepthOfMessage = 10;
    static constexpr std::size_t DepthOfQueue = 1000;

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
    // 10000; unset: DepthOfMessage, or DepthOfQueue. MaxRate is in samples a second; 0: no limit.
    std::optional<std::size_t> Depth{};
    double MaxRate = 0.0;
    // A topic that is read becomes STALE when nothing came for this long; 0: only when its writers are gone.
    std::chrono::milliseconds StaleAfter{0};
    // For a topic that is read: true if its age counts from the samples' source time, and not from their
    // arrival. The writer's clock is then believed to show UTC.
    bool SourceTimeIsTrusted = false;
    // For Delivery::Queue: samples that may wait for room in the queue, or messages that may wait to be
    // written, 1 to 1,000,000. CapacityBytes: their serialized bytes, 1 to 2^40. Further samples are dropped,
    // further messages are refused when they are added. A sample above CapacityBytes waits only alone.
    std::size_t Capacity = 1000;
    std::size_t CapacityBytes = 16u << 20;
    int Line = 0;  // where it stands in the file, for error messages; 0: made in code
};

}  // namespace Rabit
