#pragma once

#include <rabit/gateway/Fleet.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Ground
{

// By the name of a published message: samples a second that the configuration allows.
using RateLimits = std::map<std::string, double>;

// A message of which more is posted than the radio takes.
struct HeldStream
{
    std::string Message;
    double PostedPerS = 0;
    double SentPerS = 0;
};

// A queue of another node for which messages wait, or became too old while they did.
struct HeldLink
{
    std::string Node;
    std::string Queue;
    std::uint64_t Waiting = 0;
    std::uint64_t Expired = 0;  // since the gateway's start
};

// What the radio of this node does.
struct RadioUse
{
    bool Known = false;  // a Fleet has come
    Rabit::Gateway::AirStatus Air;
    std::vector<HeldStream> Streams;  // the most held back first
    std::vector<HeldLink> Links;      // the most waiting first
    double PostsHeldPerS = 0;         // of all streams: that were posted and may be sent, and are not
    std::uint64_t MessagesHeld = 0;   // of all links: that wait

    bool IsLimited() const { return Air.budget > 0 || Air.capacity > 0; }
};

// Tells what is held back from how the counters of Gateway/Fleet rise within a few seconds. For one thread.
//
// A stream is held back where something limits the radio and clearly less is sent than is posted; what the
// configuration's max_rate leaves out is not. A link is held back if messages have waited there for a second
// without a break, and more of them than are delivered in a second, or if some expired lately.
class RadioWatch
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration Window = std::chrono::seconds(5);
    // A shorter time tells nothing of a rate, nor that something waits.
    static constexpr Duration Shortest = std::chrono::seconds(1);

    explicit RadioWatch(RateLimits maxRates = {}) : _maxRates(std::move(maxRates)) {}

    // Takes in a Fleet that was posted at that moment. One that was taken in before changes nothing.
    void Look(const Rabit::Gateway::Fleet &fleet, Duration postedAt);

    const RadioUse &Use() const { return _use; }

private:
    struct Posts
    {
        std::uint64_t Offered = 0;
        std::uint64_t Replaced = 0;
    };
    struct Messages
    {
        std::uint64_t Delivered = 0;
        std::uint64_t Expired = 0;
        Duration EmptyAt{0};  // when nothing waited last, as far as is known
    };
    using LinkName = std::pair<std::string, std::string>;  // node, queue
    struct Counters
    {
        Duration At{0};
        std::map<std::string, Posts> Streams;
        std::map<LinkName, Messages> Links;
    };

    Counters CountersOf(const Rabit::Gateway::Fleet &fleet, Duration postedAt) const;
    void Keep(Counters counters);
    void LookAtStreams(double seconds);
    void LookAtLinks(const Rabit::Gateway::Fleet &fleet, double seconds);

    const RateLimits _maxRates;
    std::uint64_t _incarnation = 0;
    std::deque<Counters> _history;  // oldest first, some window long
    RadioUse _use;
};

}  // namespace Ground
