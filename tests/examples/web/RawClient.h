#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

#include <string>

namespace GroundTest
{

// A connection without TLS that sends any bytes.
class RawClient
{
public:
    // `from`: the address of the client; null: any.
    explicit RawClient(const boost::asio::ip::tcp::endpoint &server, const char *from = nullptr)
    {
        _socket.open(server.protocol());
        if (from != nullptr)
            _socket.bind({boost::asio::ip::make_address(from), 0});
        _socket.connect(server);
    }
    // The server may have closed the connection already.
    void Send(const std::string &bytes)
    {
        boost::system::error_code ignored;
        boost::asio::write(_socket, boost::asio::buffer(bytes), ignored);
    }
    // Returns all that comes until the server closes.
    std::string Rest()
    {
        std::string text;
        boost::system::error_code error;
        boost::asio::read(_socket, boost::asio::dynamic_buffer(text), error);
        return text;
    }
    boost::asio::ip::tcp::socket &Socket() { return _socket; }

private:
    boost::asio::io_context _io;
    boost::asio::ip::tcp::socket _socket{_io};
};

}  // namespace GroundTest
