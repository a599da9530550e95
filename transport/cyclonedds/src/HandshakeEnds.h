#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "VendorTraffic.h"
#include "common/Rtps.h"

namespace Rabit::Cyclone
{

// Repeats the last message of a DDS Security handshake, which goes to the peer that has sent its certificate
// as a reply. The vendor sends it once. A peer that did not get it sends its certificate again and again, and
// the vendor never answers. So it is repeated here, after Delay: Fast DDS does not listen while it sends its
// certificate, and never a second time to the same message. Thread-safe.
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

    // Takes any datagram that is sent.
    void Sent(std::span<const std::uint8_t> datagram, const RabitCycloneRoute &route);
    // Takes any datagram that was received.
    void Received(std::span<const std::uint8_t> datagram, TimePoint now);
    // Repeats nothing to that participant, until more is sent to it.
    void Forget(const Rtps::GuidPrefix &peer);
    // Returns the datagrams to repeat by now.
    std::vector<Datagram> TakeDue(TimePoint now);

private:
    using Peer = Rtps::GuidPrefix;
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
