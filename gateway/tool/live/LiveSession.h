#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "live/LiveContext.h"
#include "live/LiveQueue.h"

namespace Rabit::Tool
{

// The connection of one viewer, from the HTTP request on. Owns itself: it lives while an operation is under
// way. Server's thread only.
class LiveSession : public std::enable_shared_from_this<LiveSession>
{
public:
    LiveSession(boost::asio::ip::tcp::socket socket, LiveContext &context);
    ~LiveSession();
    LiveSession(const LiveSession &) = delete;
    LiveSession &operator=(const LiveSession &) = delete;

    void Begin();
    // Offers a new channel to the viewer.
    void Offer(const LiveProtocol::Channel &channel);
    void Show(const std::shared_ptr<const LiveValue> &value);

private:
    using Request = boost::beast::http::request<boost::beast::http::string_body>;

    void OnHandshake();
    // Returns why the request is refused; empty if the viewer may look.
    std::string WhyNot() const;
    // The token in the address of the request; empty if there is none.
    std::string_view ShownToken() const;
    bool ShowsToken(Keys::TokenGuard &guard) const;
    void Refuse(const std::string &why);
    void Accept();
    void Opened();
    void Read();
    void OnRequest(const LiveProtocol::Request &request);
    void Say(std::string text);
    void WriteNext();
    void Tick();
    void TellDropped();
    void End();

    LiveContext &_context;
    const boost::asio::ip::address _from;
    boost::beast::websocket::stream<boost::beast::tcp_stream> _stream;
    boost::asio::steady_timer _timer;
    boost::beast::flat_buffer _buffer;
    Request _request;
    boost::beast::http::response<boost::beast::http::string_body> _answer;
    LiveQueue _queue;
    std::map<std::uint32_t, std::vector<std::uint32_t>> _subscribed;  // subscriptions, by channel
    std::map<std::uint32_t, std::uint32_t> _subscriptions;            // channels, by subscription
    std::map<std::uint32_t, std::uint64_t> _dropped;  // values that the viewer was told it missed, by channel
    std::string _text;                                // being written
    std::vector<std::uint8_t> _frame;                 // likewise
    bool _hasSeat = false;
    bool _open = false;
    bool _writing = false;
};

}  // namespace Rabit::Tool
