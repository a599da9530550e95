#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/links/LinkNode.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "air/AirSchedule.h"
#include "paths/PathChoice.h"
#include "queues/LinkDriver.h"

namespace Rabit
{

// The queue links as streams of the schedule: each link is one, of the class and weight of the first `send`
// rule that fits. For each node there is one for acknowledgements and hellos, of class command. A stream
// without anything to send for a minute is removed, and made again when needed. An existing stream needs no
// allocation. Gateway's thread only.
class LinkStreams
{
public:
    using Duration = std::chrono::nanoseconds;

    // Number of copies of a datagram that are sent for that node.
    using CopiesTo = std::function<std::size_t(std::string_view node)>;

    // Of the links to nodes that `path` carries. References must outlive the object.
    LinkStreams(const std::vector<SendRule> &rules, LinkDriver &links, AirSchedule &schedule, CopiesTo copies,
                const PathChoice &choice, std::size_t path);

    // Tells the schedule which links could send now, in datagrams of at most `most` bytes on the air.
    void Look(std::size_t most, Duration now);
    // Sends one datagram of the chosen stream, of at most `most` bytes and no more than the budget has room
    // for now. Returns false if the stream is no link stream. `sent`: true if there was a datagram.
    bool Send(StreamId id, std::size_t most, Duration now, bool &sent);

private:
    struct Stream
    {
        const std::string *Node = nullptr;
        const std::string *Queue = nullptr;  // empty: acknowledgements and hellos
        StreamId Id;
        Duration ReadyAt{0};  // last
        bool IsReady = false;
        std::uint64_t SeenIn = 0;
    };
    using Queues = std::map<std::string, Stream, std::less<>>;

    void Visit(const LinkStream &link);
    Stream &StreamOf(const LinkStream &link);
    void Sweep(Duration now);

    const std::vector<SendRule> &_rules;
    LinkDriver &_links;
    AirSchedule &_schedule;
    const CopiesTo _copies;
    const PathChoice &_choice;
    const std::size_t _path;
    const std::function<void(const LinkStream &)> _visit;
    std::map<std::string, Queues, std::less<>> _nodes;
    std::vector<Stream *> _byIndex;  // of the schedule's streams; null: not one of these
    std::uint64_t _looks = 0;
    Duration _now{0};
    Duration _nextSweep{0};
};

}  // namespace Rabit
