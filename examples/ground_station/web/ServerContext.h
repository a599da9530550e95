#pragma once

#include "HttpAnswer.h"
#include "WebServer.h"

#include <atomic>
#include <memory>
#include <set>
#include <string>

namespace Ground
{
class PageSession;

// What the sessions of a WebServer share. All but the counters and pictures is for the server's thread, or
// set before it starts.
struct ServerContext
{
    WebServer::Settings Settings;
    std::span<const PageFile> Files;
    RequestGuard Guard;
    WebServer::RequestHandler Handler;
    PictureStore Pictures;
    std::set<PageSession *> Pages;              // each enters itself, and leaves in its destructor
    std::shared_ptr<const std::string> Latest;  // snapshot; null before the first

    std::atomic<std::size_t> ConnectionsOpen{0};
    std::atomic<std::uint64_t> Connections{0};
    std::atomic<std::uint64_t> ConnectionsRefused{0};
    std::atomic<std::uint64_t> PagesOpened{0};
    std::atomic<std::uint64_t> PagesOpen{0};
    std::atomic<std::uint64_t> SnapshotsSent{0};
    std::atomic<std::uint64_t> SnapshotsSkipped{0};
};

// One connection, for as long as it is held.
class ConnectionSlot
{
public:
    explicit ConnectionSlot(ServerContext &context) : _context(context) { ++_context.ConnectionsOpen; }
    ~ConnectionSlot() { --_context.ConnectionsOpen; }
    ConnectionSlot(const ConnectionSlot &) = delete;
    ConnectionSlot &operator=(const ConnectionSlot &) = delete;

private:
    ServerContext &_context;
};

}  // namespace Ground
