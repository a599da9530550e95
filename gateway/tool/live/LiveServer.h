#pragma once

#include <boost/asio/ip/tcp.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "live/LiveProtocol.h"

namespace Rabit::Tool
{

// Shows values to viewers, as they come: a server of the Foxglove WebSocket protocol (LiveProtocol), by
// Boost.Beast on a thread of its own. It can be looked at, and nothing can be sent.
//
// - A viewer sees what it subscribes to; of a channel of states the last value at once.
// - What waits for a viewer that is slow, or reads nothing, is bounded; what it is not shown it is told of,
// by
//   topic, once a second. It delays nobody else.
// - A channel stays for as long as the server: a node that comes back goes on in the same panels.
// - Pages of other sites than viewers' are refused: a browser would let any page look at loopback.
//
// What comes from the network is bounded: requests, their time, the number of viewers. Nothing from it throws
// out of here. All functions may be called from any thread.
class LiveServer
{
public:
    struct Settings
    {
        boost::asio::ip::tcp::endpoint Endpoint{boost::asio::ip::address_v4::loopback(), 8765};
        std::string Name = "rabit";
        // Sites whose pages may look, besides those of Foxglove, Lichtblick and this machine; `*`: all.
        std::vector<std::string> Origins{};
        std::size_t MostViewers = 16;
        std::size_t BytesOfViewer = std::size_t{8} << 20;  // that wait for one
        std::chrono::seconds Silence{30};  // a viewer that does not even answer pings for so long is gone
    };
    static constexpr std::size_t LargestRequest = 64 << 10;
    // What waits for the server's own thread; what comes beyond is not shown to anybody, and counted.
    static constexpr std::size_t LargestBacklog = std::size_t{64} << 20;

    // Listens from here on. Throws NetworkError.
    explicit LiveServer(const Settings &settings);
    ~LiveServer();
    LiveServer(const LiveServer &) = delete;
    LiveServer &operator=(const LiveServer &) = delete;

    // Offers one more to all viewers; returns its id, which replaces what the channel has.
    std::uint32_t AddChannel(LiveProtocol::Channel channel, bool isState);
    // A value of that channel, which came at that time: UTC in nanoseconds since 1970.
    void Show(std::uint32_t channel, std::uint64_t time, std::vector<std::uint8_t> bytes);

    boost::asio::ip::tcp::endpoint Endpoint() const;
    struct Counters
    {
        std::uint64_t Viewers = 0;  // now
        std::uint64_t Shown = 0;    // values, to each viewer
        std::uint64_t Dropped = 0;  // that a slow viewer was not shown, or the backlog had no room for
    };
    Counters Count() const;

private:
    class Core;
    const std::unique_ptr<Core> _core;
};

}  // namespace Rabit::Tool
