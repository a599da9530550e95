#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "VendorTraffic.h"

namespace Rabit::Cyclone
{

// The last message of a handshake of DDS Security, which goes to who was asked for its certificate and has
// shown it. The vendor says it once. Who did not get it shows its certificate again and again, and
// nobody would ever answer: so it is said again here. Thread-safe.
class HandshakeEnds
{
public:
    struct Datagram
    {
        RabitCycloneRoute Route;
        std::vector<std::uint8_t> Bytes;
    };
    using TimePoint = std::chrono::steady_clock::time_point;
    static constexpr std::size_t MostPeers = 256;
    static constexpr std::chrono::milliseconds ShortestGap{200};

    // Of anything that is sent.
    void Sent(std::span<const std::uint8_t> datagram, const RabitCycloneRoute &route, TimePoint now);
    // Of anything that came: what is to be sent again for it.
    std::optional<Datagram> Received(std::span<const std::uint8_t> datagram, TimePoint now);

private:
    using Peer = std::array<std::uint8_t, 12>;  // how its GUID begins
    struct End
    {
        Peer To;
        TimePoint At;
        Datagram What;
    };

    std::mutex _mutex;
    std::deque<End> _ends;  // guarded by _mutex; the oldest first
};

}  // namespace Rabit::Cyclone
