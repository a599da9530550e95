#pragma once

#include "ConnectionGate.h"
#include "PageFiles.h"
#include "PictureStore.h"
#include "WebAddress.h"
#include "WebSecrets.h"

#include <boost/asio/ip/tcp.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace Ground
{

// Serves the page and its pictures by HTTP, and to each open page, by a WebSocket on the same port, the
// latest snapshot. Boost.Beast on a thread of its own.
//
// A page answers every snapshot that it has shown with the text `seen`. At most SnapshotsUnderWay are sent
// ahead of that, and what comes meanwhile is skipped but for the latest: a slow page or line gets fewer
// snapshots, never older ones, and what is kept for it does not grow. Any other text is handed to the request
// handler; what that returns goes to the page that asked.
//
// What comes from the network is bounded: size of requests and messages, time for a request, silence (the
// server sends pings), number of connections (see ConnectionGate), replies that wait. Whoever goes beyond is
// disconnected. Nothing from the network throws out of here.
//
// With secrets it speaks TLS alone, and gives nothing to who does not show the token (see TokenGuard): by the
// address that Addresses says, and from then on by a cookie. Without, whoever reaches it may look and
// command.
//
// Threads: Start, Stop and the destructor belong to one thread; the rest may be called from any.
class WebServer
{
public:
    struct Settings
    {
        boost::asio::ip::tcp::endpoint Endpoint{boost::asio::ip::address_v4::loopback(), 0};
        ConnectionGate::Limits Connections{};          // more are closed at once
        std::chrono::milliseconds RequestTime{10000};  // for a request to come, or an answer to be taken
        std::chrono::milliseconds Silence{15000};      // after which a WebSocket is given up
        std::optional<WebSecrets> Secrets{};
    };
    static constexpr std::size_t MaxHeaderBytes = 8192;
    static constexpr std::size_t MaxMessageBytes = 4096;
    static constexpr std::size_t MaxRepliesWaiting = 64;
    static constexpr std::size_t SnapshotsUnderWay = 2;

    // Gets a text from a page on the server's thread; returns the reply, empty if there is none. What it
    // throws is logged, and the page is disconnected.
    using RequestHandler = std::function<std::string(const std::string &text)>;

    // What has happened so far.
    struct Counters
    {
        std::uint64_t Connections = 0;         // taken
        std::uint64_t ConnectionsRefused = 0;  // one too many
        std::uint64_t ConnectionsDropped = 0;  // idle ones that made room for others
        std::uint64_t HandshakesFailed = 0;    // of TLS
        std::uint64_t PagesOpened = 0;         // WebSockets
        std::uint64_t PagesOpen = 0;           // now
        std::uint64_t SnapshotsSent = 0;
        std::uint64_t SnapshotsSkipped = 0;  // replaced by a later one before they were sent to some page
    };

    // Listens from here on, so that a port that is taken is known before anything else starts; connections
    // wait until Start. Throws WebServerError. The files must outlive the server.
    explicit WebServer(const Settings &settings, std::span<const PageFile> files = PageFiles());
    ~WebServer();
    WebServer(const WebServer &) = delete;
    WebServer &operator=(const WebServer &) = delete;

    // Serves on a thread of its own until Stop. May be called again after Stop, and then listens again on the
    // same port: throws WebServerError if it was taken meanwhile.
    void Start(RequestHandler handler);
    // Closes everything and joins the thread. The handler is not called any more when it returns.
    void Stop();

    // Where it listens; the port is the one that was chosen if the settings had 0.
    boost::asio::ip::tcp::endpoint Endpoint() const;
    // Where the page is opened, with the token, and what its certificate is known by, in lines for a person.
    std::vector<std::string> Addresses() const;
    PictureStore &Pictures();
    // The text that every page is to show now. Returns at once.
    void Broadcast(std::shared_ptr<const std::string> snapshot);
    Counters Count() const;

private:
    class Core;
    const std::unique_ptr<Core> _core;
};

}  // namespace Ground
