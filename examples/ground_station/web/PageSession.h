#pragma once

#include "ServerContext.h"
#include "WebStream.h"

#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <deque>
#include <memory>
#include <string>

namespace Ground
{

// The WebSocket of one open page. It owns itself, and lives while an operation is pending.
class PageSession : public std::enable_shared_from_this<PageSession>
{
public:
    PageSession(WebStream stream, std::unique_ptr<ConnectionSlot> slot, ServerContext &context);
    ~PageSession();
    PageSession(const PageSession &) = delete;
    PageSession &operator=(const PageSession &) = delete;

    // The request must have passed RefusalOfUpgrade.
    void Accept(const HttpRequest &request);
    // Sends a new snapshot as soon as the page can take it.
    void Offer(const std::shared_ptr<const std::string> &snapshot);

private:
    void Read();
    void OnMessage();
    void Reply(std::string text);
    void WriteNext();
    void Close(boost::beast::websocket::close_code code);

    ServerContext &_context;
    const std::unique_ptr<ConnectionSlot> _slot;
    boost::beast::websocket::stream<WebStream> _stream;
    boost::beast::flat_buffer _buffer;
    bool _open = false;
    bool _writing = false;
    std::size_t _underWay = 0;                     // snapshots sent and not yet seen
    std::shared_ptr<const std::string> _snapshot;  // the snapshot to send next; null: the page has the
                                                   // latest
    std::shared_ptr<const std::string> _beingSent;
    std::deque<std::string> _replies;  // the first one may already be in a write
};

}  // namespace Ground
