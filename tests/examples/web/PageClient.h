// A browser's part of the WebSocket, for tests.
#pragma once

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace GroundTest
{

// Opens the WebSocket of a server. Every wait ends after Patience at the latest: then it has failed.
class PageClient
{
public:
    static constexpr std::chrono::seconds Patience{20};

    explicit PageClient(const boost::asio::ip::tcp::endpoint &server) : _server(server) {}

    // The status with which the server answers the upgrade; 101 if it opened, 0 if it closed the connection.
    unsigned Open(const std::string &origin = {}, const std::string &host = {},
                  const std::string &target = "/live")
    {
        const std::string name = _server.address().to_string() + ":" + std::to_string(_server.port());
        const std::string sent = host.empty() ? name : host;
        boost::beast::error_code error;
        auto &lowest = boost::beast::get_lowest_layer(_stream);
        lowest.expires_after(Patience);
        lowest.socket().connect(_server, error);
        if (error)
            return 0;
        _stream.set_option(boost::beast::websocket::stream_base::decorator(
            [&](boost::beast::websocket::request_type &request)
            {
                if (origin != "none")
                    request.set(boost::beast::http::field::origin,
                                origin.empty() ? "http://" + sent : origin);
            }));
        boost::beast::websocket::response_type response;
        error = Await([&](auto handler) { _stream.async_handshake(response, sent, target, handler); });
        return error && error != boost::beast::websocket::error::upgrade_declined ? 0 : response.result_int();
    }
    // The next text; nothing if the connection has ended or nothing comes.
    std::optional<std::string> Next()
    {
        boost::beast::flat_buffer buffer;
        const auto error =
            Await([&](auto handler)
                  { _stream.async_read(buffer, [handler](auto e, std::size_t) { handler(e); }); });
        if (error)
            return std::nullopt;
        return boost::beast::buffers_to_string(buffer.data());
    }
    bool Send(const std::string &text, bool asText = true)
    {
        _stream.text(asText);
        return !Await(
            [&](auto handler) {
                _stream.async_write(boost::asio::buffer(text),
                                    [handler](auto e, std::size_t) { handler(e); });
            });
    }
    // What the next text is when this one is answered with `seen`.
    std::optional<std::string> NextSeen()
    {
        auto text = Next();
        if (text)
            Send("seen");
        return text;
    }
    boost::beast::websocket::close_reason Reason() const { return _stream.reason(); }

private:
    template <typename Operation>
    boost::beast::error_code Await(Operation operation)
    {
        std::optional<boost::beast::error_code> result;
        operation([&result](const boost::beast::error_code &error) { result = error; });
        _io.restart();
        const auto end = std::chrono::steady_clock::now() + Patience;
        while (!result && std::chrono::steady_clock::now() < end)
            if (_io.run_one_until(end) == 0)
                break;
        if (!result)
        {
            boost::beast::get_lowest_layer(_stream).close();
            _io.restart();
            _io.run();
            return boost::asio::error::timed_out;
        }
        return *result;
    }

    const boost::asio::ip::tcp::endpoint _server;
    boost::asio::io_context _io;
    boost::beast::websocket::stream<boost::beast::tcp_stream> _stream{_io};
};

}  // namespace GroundTest
