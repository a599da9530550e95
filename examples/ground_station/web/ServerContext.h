#pragma once

#include "ConnectionGate.h"
#include "HttpAnswer.h"
#include "WebServer.h"

#include <rabit/keys/TokenGuard.h>

#include <boost/asio/ssl/context.hpp>

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

namespace Ground
{
class HttpSession;
class PageSession;

// The secrets of a server: see WebServer::Settings::Secrets.
struct ServerSecrets
{
    std::optional<boost::asio::ssl::context> Tls;
    Rabit::Keys::TokenGuard Guard;
    std::string Token;
    std::string Cookie;  // its name
};

// State shared by the sessions of a WebServer. Everything except the counters and pictures is used only on
// the server's thread, or set before it starts.
struct ServerContext
{
    WebServer::Settings Settings;
    std::span<const PageFile> Files;
    RequestGuard Guard;
    std::unique_ptr<ServerSecrets> Secrets;  // null: it has none
    WebServer::RequestHandler Handler;
    PictureStore Pictures;
    ConnectionGate Gate;
    std::map<ConnectionGate::Id, HttpSession *> Requests;  // each adds itself, and removes itself in its
                                                           // destructor
    std::set<PageSession *> Pages;                         // likewise
    std::shared_ptr<const std::string> Latest;             // snapshot; null before the first

    std::atomic<std::uint64_t> Connections{0};
    std::atomic<std::uint64_t> ConnectionsRefused{0};
    std::atomic<std::uint64_t> ConnectionsDropped{0};
    std::atomic<std::uint64_t> HandshakesFailed{0};
    std::atomic<std::uint64_t> PagesOpened{0};
    std::atomic<std::uint64_t> PagesOpen{0};
    std::atomic<std::uint64_t> SnapshotsSent{0};
    std::atomic<std::uint64_t> SnapshotsSkipped{0};
};

// Holds the place of one connection while it lives.
class ConnectionSlot
{
public:
    ConnectionSlot(ServerContext &context, ConnectionGate::Id id) : _context(context), _id(id) {}
    ~ConnectionSlot() { _context.Gate.Leaves(_id); }
    ConnectionSlot(const ConnectionSlot &) = delete;
    ConnectionSlot &operator=(const ConnectionSlot &) = delete;

    ConnectionGate::Id Id() const { return _id; }

private:
    ServerContext &_context;
    const ConnectionGate::Id _id;
};

}  // namespace Ground
