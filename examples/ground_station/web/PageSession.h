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

// The WebSocket of one open page. It owns itself: it lives while something is under way.
class PageSession : public std::enable_shared_from_this<PageSession>
{
public:
    PageSession(WebStream stream, std::unique_ptr<ConnectionSlot> slot, ServerContext &context);
    ~PageSession();
    PageSession(const PageSession &) = delete;
    PageSession &operator=(const PageSession &) = delete;

    // The request must have been found good.
    void Accept(const HttpRequest &request);
    // There is a new snapshot.
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
    std::shared_ptr<const std::string> _snapshot;  // the one to send next; null: it has the latest
    std::shared_ptr<const std::string> _beingSent;
    std::deque<std::string> _replies;  // the first one may be being sent
};

}  // namespace Ground
