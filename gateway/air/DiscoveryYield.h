#pragma once

#include <chrono>
#include <optional>

namespace Rabit
{

// What is said again and again gives way to what nodes have to say to find each other. Without that a command
// cannot go at all; and where the air is full of states, discovery, which is as quick as its answers, says
// the least that it may, and a fleet that starts at once is mute for ten seconds.
//
// Holds back while discovery has been held up for Patience, and for Rest after that, but no longer than
// Longest at a stretch: what waits then, waits for something else than air. Pure; `now` never goes back.
class DiscoveryYield
{
public:
    using Duration = std::chrono::nanoseconds;
    static constexpr Duration Patience = std::chrono::milliseconds(300);
    static constexpr Duration Rest = std::chrono::milliseconds(500);
    static constexpr Duration Longest = std::chrono::seconds(20);
    // Of a message, meanwhile.
    static constexpr Duration Gap = std::chrono::seconds(1);

    // discoveryHeldUp: TransportSession::DiscoveryHeldUp, now. How much time there has to be at least between
    // two samples of one message; 0: as the rules say.
    Duration LeastGap(Duration discoveryHeldUp, Duration now)
    {
        if (discoveryHeldUp < Patience)
        {
            _since = now < _until ? _since : std::nullopt;
        }
        else if (now - _since.value_or(now) < Longest)
        {
            _since = _since.value_or(now);
            _until = now + Rest;
        }
        return now < _until ? Gap : Duration(0);
    }

private:
    std::optional<Duration> _since;
    Duration _until = Duration::min();
};

}  // namespace Rabit
