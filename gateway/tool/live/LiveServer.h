#pragma once

#include <rabit/node/TcpServer.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "live/LiveProtocol.h"

namespace Rabit::Tool
{

struct LiveContext;
class LiveSession;

// Shows values to viewers, as they come: a server of the Foxglove WebSocket protocol (LiveProtocol), by
// Boost.Beast on a thread of its own. Viewers can look, and cannot send values.
//
// - A viewer gets the values of its subscriptions; of a channel of States the last value at once.
// - The values that wait for a slow viewer are bounded. Once a second it is told how many it missed, by
//   topic. It delays no other viewer. It misses no State's newest value.
// - A channel stays for as long as the server: a node that comes back goes on in the same panels.
// - A viewer must show the token in the address (Settings::Token): other users of the machine reach loopback,
//   too. After wrong tokens the server lets an address wait (rabit/keys/TokenGuard.h).
// - Pages of other sites than viewers' are refused: a browser would let any page look at loopback.
//
// Requests from the network, their time and the number of viewers are bounded. Nothing from the network makes
// a function throw. All functions may be called from any thread.
class LiveServer
{
public:
    struct Settings
    {
        boost::asio::ip::tcp::endpoint Endpoint{boost::asio::ip::address_v4::loopback(), 8765};
        std::string Name = "rabit";
        // Origins whose pages may look, besides the sites of Foxglove and Lichtblick; `*`: all. `file://`: a
        // viewer that is installed, and any page that is saved on this machine.
        std::vector<std::string> Origins{};
        std::string Token{};  // that viewers must show; empty: none
        std::size_t MostViewers = 16;
        std::size_t BytesOfViewer = std::size_t{8} << 20;  // that wait for one viewer
        std::chrono::seconds Silence{30};  // a viewer that does not even answer pings for so long is gone
    };
    static constexpr std::size_t LargestRequest = 64 << 10;
    // Bytes that wait for the server's own thread. Values beyond are shown to nobody, and counted.
    static constexpr std::size_t LargestBacklog = std::size_t{64} << 20;

    // Starts to listen. Throws std::runtime_error.
    explicit LiveServer(const Settings &settings);
    ~LiveServer();
    LiveServer(const LiveServer &) = delete;
    LiveServer &operator=(const LiveServer &) = delete;

    // Offers a channel to all viewers. Returns its id; `channel.Id` is ignored.
    std::uint32_t AddChannel(LiveProtocol::Channel channel, bool isState);
    // Shows a value of that channel; `time` is its arrival, UTC in nanoseconds since 1970.
    void Show(std::uint32_t channel, std::uint64_t time, std::vector<std::uint8_t> bytes);

    boost::asio::ip::tcp::endpoint Endpoint() const { return _server->Address(); }
    struct Counters
    {
        std::uint64_t Viewers = 0;  // now
        std::uint64_t Shown = 0;    // values, to each viewer
        std::uint64_t Dropped = 0;  // not shown to a slow viewer, or beyond the backlog
    };
    Counters Count() const;

private:
    std::vector<LiveSession *> Sessions() const;

    const std::unique_ptr<LiveContext> _context;
    std::atomic<std::uint32_t> _lastChannel{0};
    std::atomic<std::size_t> _backlog{0};  // bytes
    std::unique_ptr<TcpServer> _server;    // ends the sessions, which use the context
};

}  // namespace Rabit::Tool
