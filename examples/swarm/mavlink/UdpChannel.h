#pragma once

#include "ByteChannel.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

#include <chrono>
#include <cstdint>

namespace Swarm
{

// Datagrams of one autopilot. The first sender is the peer: its datagrams alone are received, and only it is
// answered. Datagrams of other senders are dropped, and the log names the first of them. Another sender
// becomes the peer only after the peer has been silent for PeerSilentAfter, as an autopilot that was started
// again has another port. Time in which nobody called Receive is no silence. Sender addresses can be forged,
// so bind to an address that only the autopilot can reach.
class UdpChannel final : public ByteChannel
{
public:
    using Endpoint = boost::asio::ip::udp::endpoint;

    // Longer than MavlinkVehicle::SilentAfter: by then the autopilot counts as gone.
    static constexpr std::chrono::seconds PeerSilentAfter{5};
    // After a longer time between two calls of Receive this process stood still: datagrams of all senders
    // wait, in any order.
    static constexpr std::chrono::seconds Standstill{1};

    // Throws boost::system::system_error.
    explicit UdpChannel(const Endpoint &local);

    // Drops at most 200 datagrams of other senders in all calls with the same `now`, so that a flood does not
    // hold up the manager.
    std::size_t Receive(std::span<std::uint8_t> buffer, Time now) override;
    bool Send(std::span<const std::uint8_t> bytes) override;

    Endpoint Local() const { return _socket.local_endpoint(); }
    // Datagrams that were dropped, because they came from another sender than the peer.
    std::uint64_t Dropped() const { return _dropped; }

private:
    // True if `sender` is the peer, or becomes it.
    bool IsPeer(const Endpoint &sender, Time now);

    boost::asio::io_context _context;
    boost::asio::ip::udp::socket _socket{_context};
    Endpoint _peer;  // port 0: none yet
    Time _heardAt{0};
    Time _calledAt{0};  // the last Receive
    int _droppedNow = 0;
    std::uint64_t _dropped = 0;
    bool _tellsOfOthers = true;  // until the first datagram of another sender is dropped
};

}  // namespace Swarm
