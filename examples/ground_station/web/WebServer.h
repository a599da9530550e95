#pragma once

#include "ConnectionGate.h"
#include "PageFiles.h"
#include "PictureStore.h"
#include "WebAddress.h"
#include "WebSecrets.h"

#include <rabit/node/TcpServer.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace Ground
{

struct ServerContext;

// Serves the page and its pictures by HTTP, and to each open page, by a WebSocket on the same port, the
// latest snapshot. Boost.Beast on a thread of its own.
//
// A page answers every snapshot that it has shown with the text `seen`. At most SnapshotsUnderWay are sent
// ahead of that; of later ones only the latest is kept. So a slow page or line gets fewer snapshots, never
// older ones, and its memory does not grow. Any other text goes to the request handler, whose reply goes to
// the page that sent it.
//
// Input from the network is bounded: size of requests and messages, time for a request, silence (the server
// sends pings), number of connections (see ConnectionGate), replies that wait. A peer that exceeds a limit
// is disconnected. No input from the network makes a method throw.
//
// With secrets it serves only browsers that show the token (rabit/keys/TokenGuard.h): first in the address
// that Addresses returns, later by a cookie. If the secrets have a certificate, it speaks TLS only. Without
// secrets, anybody who reaches it may view and command.
//
// Threads: Start, Stop and the destructor belong to one thread; the rest may be called from any.
class WebServer
{
public:
    struct Settings
    {
        boost::asio::ip::tcp::endpoint Endpoint{boost::asio::ip::address_v4::loopback(), 0};
        ConnectionGate::Limits Connections{};          // connections beyond are closed at once
        std::chrono::milliseconds RequestTime{10000};  // for a request to arrive, or an answer to be
                                                       // received
        std::chrono::milliseconds Silence{15000};      // after which a WebSocket is closed
        std::optional<WebSecrets> Secrets{};
    };
    static constexpr std::size_t MaxHeaderBytes = 8192;
    static constexpr std::size_t MaxMessageBytes = 4096;
    static constexpr std::size_t MaxRepliesWaiting = 64;
    static constexpr std::size_t SnapshotsUnderWay = 2;

    // Gets a text from a page on the server's thread; returns the reply, empty if there is none. If it
    // throws, that is logged and the page is disconnected.
    using RequestHandler = std::function<std::string(const std::string &text)>;

    // Counts of events so far.
    struct Counters
    {
        std::uint64_t Connections = 0;         // taken
        std::uint64_t ConnectionsRefused = 0;  // too many connections
        std::uint64_t ConnectionsDropped = 0;  // idle ones closed to make room
        std::uint64_t HandshakesFailed = 0;    // of TLS
        std::uint64_t PagesOpened = 0;         // WebSockets
        std::uint64_t PagesOpen = 0;           // now
        std::uint64_t SnapshotsSent = 0;
        std::uint64_t SnapshotsSkipped = 0;  // replaced by a later one before they were sent to some page
    };

    // Listens from here on, so that a port in use is reported before anything else starts; connections wait
    // until Start. Throws WebServerError. The files must outlive the server.
    explicit WebServer(const Settings &settings, std::span<const PageFile> files = PageFiles());
    ~WebServer();
    WebServer(const WebServer &) = delete;
    WebServer &operator=(const WebServer &) = delete;

    // Serves on a thread of its own until Stop. May be called again after Stop, and then listens again on
    // the same port: throws WebServerError if another program uses it by now.
    void Start(RequestHandler handler);
    // Closes everything and joins the thread. After it returns, the handler is not called any more.
    void Stop();

    // The address of the server; with port 0 in the settings, this has the chosen port.
    boost::asio::ip::tcp::endpoint Endpoint() const { return _endpoint; }
    // The addresses of the page with the token, and the fingerprint of its certificate, in lines for a
    // person.
    std::vector<std::string> Addresses() const;
    PictureStore &Pictures();
    // Sends a text for every page to show. Returns at once.
    void Broadcast(std::shared_ptr<const std::string> snapshot);
    Counters Count() const;

private:
    void Listen();
    void Take(Rabit::TcpServer::Socket socket);
    void Distribute();

    const std::unique_ptr<ServerContext> _context;
    boost::asio::ip::tcp::endpoint _endpoint;
    // Made anew for each run: destroying it ends every session.
    std::unique_ptr<Rabit::TcpServer> _server;
    std::mutex _mutex;
    boost::asio::io_context *_postable = nullptr;  // guarded; null: posting is not allowed
    std::shared_ptr<const std::string> _next;      // guarded; not null: a call of Distribute waits
};

}  // namespace Ground
