#include "WebStream.h"

#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>

namespace Ground
{

WebStream::Tls &WebStream::UseTls(boost::asio::ssl::context &context)
{
    Plain plain = std::move(std::get<Plain>(_stream));
    return _stream.emplace<Tls>(std::move(plain), context);
}

void WebStream::Read(const First<boost::asio::mutable_buffer> &buffers, Transferred done)
{
    std::visit([&](auto &stream) { stream.async_read_some(buffers, std::move(done)); }, _stream);
}

void WebStream::Write(const First<boost::asio::const_buffer> &buffers, Transferred done)
{
    std::visit([&](auto &stream) { stream.async_write_some(buffers, std::move(done)); }, _stream);
}

void WebStream::TearDown(boost::beast::role_type role, std::function<void(Error)> done)
{
    using boost::beast::async_teardown;
    using boost::beast::websocket::async_teardown;
    std::visit([&](auto &stream) { async_teardown(role, stream, std::move(done)); }, _stream);
}

}  // namespace Ground
