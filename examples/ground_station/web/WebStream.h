#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

namespace Ground
{

// A connection with TLS or without, with the interface of a Boost.Beast stream, hence the lower-case names.
//
// Buffers and handlers of all operations are put into one type each. So the code of TLS and of sockets is
// compiled once, in WebStream.cpp, and not for each operation of HTTP and of WebSockets.
class WebStream
{
public:
    using Plain = boost::beast::tcp_stream;
    using Tls = boost::beast::ssl_stream<Plain>;
    using executor_type = Plain::executor_type;

    explicit WebStream(Plain plain) : _stream(std::in_place_type<Plain>, std::move(plain)) {}

    // Uses TLS from now on; the caller does the handshake.
    Tls &UseTls(boost::asio::ssl::context &context);
    // Null without TLS.
    Tls *GetTls() { return std::get_if<Tls>(&_stream); }

    Plain &next_layer() noexcept
    {
        Tls *const tls = GetTls();
        return tls != nullptr ? tls->next_layer() : *std::get_if<Plain>(&_stream);
    }
    executor_type get_executor() noexcept { return next_layer().get_executor(); }

    // Both transfer at least one byte, unless the buffers have no room, and need not transfer all.
    template <typename Sequence, typename Handler>
    void async_read_some(const Sequence &buffers, Handler &&handler)
    {
        Read(First<boost::asio::mutable_buffer>(buffers),
             Keep<Error, std::size_t>(std::forward<Handler>(handler)));
    }
    template <typename Sequence, typename Handler>
    void async_write_some(const Sequence &buffers, Handler &&handler)
    {
        Write(First<boost::asio::const_buffer>(buffers),
              Keep<Error, std::size_t>(std::forward<Handler>(handler)));
    }
    template <typename Handler>
    friend void async_teardown(boost::beast::role_type role, WebStream &stream, Handler &&handler)
    {
        stream.TearDown(role, Keep<Error>(std::forward<Handler>(handler)));
    }

private:
    using Error = boost::beast::error_code;
    using Transferred = std::function<void(Error, std::size_t)>;

    // The first buffers of a sequence that are not empty.
    template <typename Buffer>
    class First
    {
    public:
        using value_type = Buffer;
        using const_iterator = const Buffer *;

        template <typename Sequence>
        explicit First(const Sequence &buffers)
        {
            const auto end = boost::asio::buffer_sequence_end(buffers);
            for (auto at = boost::asio::buffer_sequence_begin(buffers); at != end && _size < _buffers.size();
                 ++at)
                if (const Buffer buffer(*at); buffer.size() > 0)
                    _buffers[_size++] = buffer;
        }
        const_iterator begin() const { return _buffers.data(); }
        const_iterator end() const { return _buffers.data() + _size; }

    private:
        std::array<Buffer, 8> _buffers;
        std::size_t _size = 0;
    };

    // A function that can be copied, as the operations of Boost.Beast cannot.
    template <typename... Arguments, typename Handler>
    static std::function<void(Arguments...)> Keep(Handler &&handler)
    {
        return [kept = std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler))](
                   Arguments... arguments) { (*kept)(arguments...); };
    }

    void Read(const First<boost::asio::mutable_buffer> &buffers, Transferred done);
    void Write(const First<boost::asio::const_buffer> &buffers, Transferred done);
    void TearDown(boost::beast::role_type role, std::function<void(Error)> done);

    std::variant<Plain, Tls> _stream;
};

}  // namespace Ground
