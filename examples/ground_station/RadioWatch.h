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

// Maximum rate of a published message by name, in samples a second, from the configuration.
using RateLimits = std::map<std::string, double>;

// A message that is posted faster than the radio can send it.
struct HeldStream
{
    std::string Message;
    double PostedPerS = 0;
    double SentPerS = 0;
};

// A queue of another node for which messages wait, or have expired while waiting.
struct HeldLink
{
    std::string Node;
    std::string Queue;
    std::uint64_t Waiting = 0;
    std::uint64_t Expired = 0;  // since the gateway's start
};

// The state of this node's radio.
struct RadioUse
{
    bool Known = false;  // a Fleet has come
    Rabit::Gateway::AirStatus Air;
    std::vector<HeldStream> Streams;  // the most held back first
    std::vector<HeldLink> Links;      // the most waiting first
    double PostsHeldPerS = 0;         // of all streams: posts that max_rate allows, but that were not sent
    std::uint64_t MessagesHeld = 0;   // of all links: waiting messages

    bool IsLimited() const { return Air.budget > 0 || Air.capacity > 0; }
};

// Finds held-back streams and links by the rise of the counters of Gateway/Fleet within a few seconds. Not
// thread-safe.
//
// A stream is held back if something limits the radio and clearly less is sent than posted; posts dropped
// by max_rate do not count. A link is held back if messages have waited there for an unbroken second, and
// more of them than are delivered in a second. It is also held back if some expired recently.
class RadioWatch
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration Window = std::chrono::seconds(5);
    // Shortest time from which a rate, or that messages wait, can be derived.
    static constexpr Duration Shortest = std::chrono::seconds(1);

    explicit RadioWatch(RateLimits maxRates = {}) : _maxRates(std::move(maxRates)) {}

    // Accepts a Fleet that was posted at that moment. The same Fleet again changes nothing.
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
        Duration EmptyAt{0};  // last time at which no message is known to have waited
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
