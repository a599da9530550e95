#include "PageClient.h"

#include "../../Eventually.h"
#include "WebStream.h"

#include <boost/asio/io_context.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <functional>
#include <utility>

namespace GroundTest
{
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

class PageClient::Connection
{
public:
    Connection(const boost::asio::ip::tcp::endpoint &server, std::optional<std::string> cookies)
        : _server(server), _cookies(std::move(cookies))
    {
    }

    unsigned Open(const std::string &origin, const std::string &host, const std::string &target)
    {
        const std::string name = _server.address().to_string() + ":" + std::to_string(_server.port());
        const std::string sent = host.empty() ? name : host;
        beast::error_code error;
        auto &lowest = beast::get_lowest_layer(_stream);
        lowest.socket().connect(_server, error);
        if (!error)  // as a browser has it: otherwise each request after "seen" waits for 40 ms
            lowest.socket().set_option(boost::asio::ip::tcp::no_delay(true), error);
        if (error || !ShakeHands())
            return 0;
        _stream.set_option(websocket::stream_base::decorator(
            [&](websocket::request_type &request)
            {
                if (origin != "none")
                    request.set(beast::http::field::origin,
                                origin.empty() ? (_cookies ? "https://" : "http://") + sent : origin);
                if (_cookies)
                    request.set(beast::http::field::cookie, *_cookies);
            }));
        websocket::response_type response;
        error =
            Await([&](const Handler &handler) { _stream.async_handshake(response, sent, target, handler); });
        return error && error != websocket::error::upgrade_declined ? 0 : response.result_int();
    }
    std::optional<std::string> Next()
    {
        beast::flat_buffer buffer;
        const auto error =
            Await([&](const Handler &handler)
                  { _stream.async_read(buffer, [handler](auto e, std::size_t) { handler(e); }); });
        if (error)
            return std::nullopt;
        return beast::buffers_to_string(buffer.data());
    }
    bool Send(const std::string &text, bool asText)
    {
        _stream.text(asText);
        return !Await(
            [&](const Handler &handler) {
                _stream.async_write(boost::asio::buffer(text),
                                    [handler](auto e, std::size_t) { handler(e); });
            });
    }

private:
    using Handler = std::function<void(const beast::error_code &)>;

    bool ShakeHands()
    {
        if (!_cookies)
            return true;
        Ground::WebStream::Tls &tls = _stream.next_layer().UseTls(_tls);
        return !Await([&](const Handler &handler)
                      { tls.async_handshake(boost::asio::ssl::stream_base::client, handler); });
    }
    beast::error_code Await(const std::function<void(const Handler &)> &operation)
    {
        std::optional<beast::error_code> result;
        operation([&result](const beast::error_code &error) { result = error; });
        _io.restart();
        while (!result && _io.run_one_for(RabitTest::Hangs) > 0)
        {
        }
        if (!result)
        {
            beast::get_lowest_layer(_stream).close();
            _io.restart();
            _io.run();
            return boost::asio::error::timed_out;
        }
        return *result;
    }

    const boost::asio::ip::tcp::endpoint _server;
    const std::optional<std::string> _cookies;
    boost::asio::io_context _io;
    boost::asio::ssl::context _tls{boost::asio::ssl::context::tls_client};
    websocket::stream<Ground::WebStream> _stream{beast::tcp_stream(_io)};
};

PageClient::PageClient(const boost::asio::ip::tcp::endpoint &server, std::optional<std::string> cookies)
    : _connection(std::make_unique<Connection>(server, std::move(cookies)))
{
}

PageClient::~PageClient() = default;

unsigned PageClient::Open(const std::string &origin, const std::string &host, const std::string &target)
{
    return _connection->Open(origin, host, target);
}

std::optional<std::string> PageClient::Next()
{
    return _connection->Next();
}

bool PageClient::Send(const std::string &text, bool asText)
{
    return _connection->Send(text, asText);
}

std::optional<std::string> PageClient::NextSeen()
{
    auto text = Next();
    if (text)
        Send("seen");
    return text;
}

}  // namespace GroundTest
