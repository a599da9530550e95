#pragma once

#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>

#include <utility>
#include <variant>

namespace Ground
{

// A connection with TLS or without, with the interface of a Boost.Beast stream, hence the lower-case names.
class WebStream
{
public:
    using Plain = boost::beast::tcp_stream;
    using Tls = boost::beast::ssl_stream<Plain>;
    using executor_type = Plain::executor_type;

    explicit WebStream(Plain plain) : _stream(std::in_place_type<Plain>, std::move(plain)) {}

    // Uses TLS from now on; the caller does the handshake.
    Tls &UseTls(boost::asio::ssl::context &context)
    {
        Plain plain = std::move(std::get<Plain>(_stream));
        return _stream.emplace<Tls>(std::move(plain), context);
    }
    // Null without TLS.
    Tls *GetTls() { return std::get_if<Tls>(&_stream); }

    Plain &next_layer() noexcept
    {
        Tls *const tls = GetTls();
        return tls != nullptr ? tls->next_layer() : *std::get_if<Plain>(&_stream);
    }
    executor_type get_executor() noexcept { return next_layer().get_executor(); }

    template <typename Buffers, typename Handler>
    void async_read_some(const Buffers &buffers, Handler &&handler)
    {
        std::visit([&](auto &stream) { stream.async_read_some(buffers, std::forward<Handler>(handler)); },
                   _stream);
    }
    template <typename Buffers, typename Handler>
    void async_write_some(const Buffers &buffers, Handler &&handler)
    {
        std::visit([&](auto &stream) { stream.async_write_some(buffers, std::forward<Handler>(handler)); },
                   _stream);
    }
    template <typename Handler>
    friend void async_teardown(boost::beast::role_type role, WebStream &stream, Handler &&handler)
    {
        using boost::beast::async_teardown;
        using boost::beast::websocket::async_teardown;
        std::visit([&](auto &inner) { async_teardown(role, inner, std::forward<Handler>(handler)); },
                   stream._stream);
    }

private:
    std::variant<Plain, Tls> _stream;
};

}  // namespace Ground
