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
// nobody would ever answer: so it is said again here. A while later: Fast DDS does not listen while it shows
// it, and never to the same once more. Thread-safe.
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
    static constexpr std::chrono::milliseconds Delay{50};

    // Of anything that is sent.
    void Sent(std::span<const std::uint8_t> datagram, const RabitCycloneRoute &route);
    // Of anything that came.
    void Received(std::span<const std::uint8_t> datagram, TimePoint now);
    // What is to be sent again by now.
    std::vector<Datagram> TakeDue(TimePoint now);

private:
    using Peer = std::array<std::uint8_t, 12>;  // how its GUID begins
    struct End
    {
        Peer To;
        Datagram What;
        std::optional<TimePoint> Due{};
    };

    std::mutex _mutex;
    std::deque<End> _ends;  // guarded by _mutex; the oldest first
};

}  // namespace Rabit::Cyclone
