#pragma once

#include "ServerContext.h"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include <memory>
#include <optional>

namespace Ground
{

// One connection while it speaks HTTP. It owns itself: it lives while something is under way.
class HttpSession : public std::enable_shared_from_this<HttpSession>
{
public:
    HttpSession(boost::asio::ip::tcp::socket socket, std::unique_ptr<ConnectionSlot> slot,
                ServerContext &context);
    ~HttpSession();
    HttpSession(const HttpSession &) = delete;
    HttpSession &operator=(const HttpSession &) = delete;

    void Read();
    // Ends it, for another one needs its place.
    void Drop();

private:
    void OnRead(const boost::beast::error_code &error);
    void Write(HttpResponse response);
    void Close();

    ServerContext &_context;
    const ConnectionGate::Id _id;
    std::unique_ptr<ConnectionSlot> _slot;
    boost::beast::tcp_stream _stream;
    boost::beast::flat_buffer _buffer;
    std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> _parser;
    std::optional<HttpResponse> _response;
};

}  // namespace Ground
