#pragma once

#include "ServerContext.h"
#include "WebStream.h"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include <memory>
#include <optional>

namespace Ground
{

// Logs wrong tokens, if a line is due.
void SayWrongTokens(ServerContext &context);

// One connection while it speaks HTTP. It owns itself, and lives while an operation is pending.
class HttpSession : public std::enable_shared_from_this<HttpSession>
{
public:
    HttpSession(boost::asio::ip::tcp::socket socket, std::unique_ptr<ConnectionSlot> slot,
                ServerContext &context);
    ~HttpSession();
    HttpSession(const HttpSession &) = delete;
    HttpSession &operator=(const HttpSession &) = delete;

    void Begin();
    // Closes the connection, as another one needs its place.
    void Drop();

private:
    void TellWhetherTls();
    void ShakeHands();
    void Read();
    void OnRead(const boost::beast::error_code &error);
    void CheckToken();
    bool ShowsToken();
    void Answer();
    void Write(HttpResponse response);
    void Close();
    boost::beast::tcp_stream &Lowest() { return _stream.next_layer(); }

    ServerContext &_context;
    const ConnectionGate::Id _id;
    const boost::asio::ip::address _from;
    std::unique_ptr<ConnectionSlot> _slot;
    WebStream _stream;
    boost::asio::steady_timer _pause;
    bool _knowsToken = false;  // has shown it on this connection
    HttpRequest _request;
    boost::beast::flat_buffer _buffer;
    std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> _parser;
    std::optional<HttpResponse> _response;
};

}  // namespace Ground
