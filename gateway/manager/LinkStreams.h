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
#include "queues/LinkDriver.h"

namespace Rabit
{

// The queue links as streams of the schedule: each link one, of the class and weight of the first `send` rule
// that fits, and for each node one of presence for acknowledgements and hellos. A stream that has had nothing
// to send for a minute is given up, and made again when it has. No allocation for one that is there.
// Gateway's thread only.
class LinkStreams
{
public:
    using Duration = std::chrono::nanoseconds;

    // How many datagrams one to that node takes.
    using CopiesTo = std::function<std::size_t(std::string_view node)>;

    // References must outlive the object.
    LinkStreams(const std::vector<SendRule> &rules, LinkDriver &links, AirSchedule &schedule,
                CopiesTo copies);

    // Tells the schedule what the links could send now, in datagrams of at most so many bytes on the air.
    void Look(std::size_t most, Duration now);
    // One of these was chosen: sends one datagram, of at most so many bytes and no more than the budget has
    // room for now. False: it is none of these. `sent`: whether there was one.
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
    const std::function<void(const LinkStream &)> _visit;
    std::map<std::string, Queues, std::less<>> _nodes;
    std::vector<Stream *> _byIndex;  // of the schedule's streams; null: not one of these
    std::uint64_t _looks = 0;
    Duration _now{0};
    Duration _nextSweep{0};
};

}  // namespace Rabit
