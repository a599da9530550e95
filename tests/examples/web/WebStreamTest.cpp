#include "WebStream.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace
{
using boost::asio::ip::tcp;

// Two ends of one connection.
class WebStreamTest : public testing::Test
{
protected:
    boost::asio::io_context _io;
    tcp::acceptor _acceptor{_io, {boost::asio::ip::address_v4::loopback(), 0}};
    tcp::socket _other{_io};
    Ground::WebStream _stream{Connected()};

    Ground::WebStream::Plain Connected()
    {
        Ground::WebStream::Plain plain(_io);
        plain.socket().connect(_acceptor.local_endpoint());
        _acceptor.accept(_other);
        return plain;
    }
    static std::vector<std::string> Pieces()
    {
        std::vector<std::string> pieces;
        for (int i = 0; i < 50; ++i)
        {
            pieces.insert(pieces.end(), 3, std::string());
            pieces.push_back("piece " + std::to_string(i) + ";");
        }
        return pieces;
    }
    template <typename Buffer>
    static std::vector<Buffer> BuffersOf(std::vector<std::string> &pieces)
    {
        std::vector<Buffer> buffers;
        for (std::string &piece : pieces)
            buffers.emplace_back(piece.data(), piece.size());
        return buffers;
    }
};

TEST_F(WebStreamTest, WritesMoreBuffersThanItTakesAtOnceAndPassesOverEmptyOnes)
{
    std::vector<std::string> pieces = Pieces();
    std::string all;
    for (const std::string &piece : pieces)
        all += piece;
    std::size_t written = 0;
    boost::asio::async_write(_stream, BuffersOf<boost::asio::const_buffer>(pieces),
                             [&](const boost::system::error_code &error, std::size_t bytes)
                             {
                                 EXPECT_FALSE(error);
                                 written = bytes;
                             });
    _io.run();
    EXPECT_EQ(written, all.size());
    std::string read(all.size(), ' ');
    boost::asio::read(_other, boost::asio::buffer(read));
    EXPECT_EQ(read, all);
}

TEST_F(WebStreamTest, ReadsIntoMoreBuffersThanItTakesAtOnce)
{
    std::vector<std::string> pieces = Pieces();
    std::string all;
    for (std::string &piece : pieces)
    {
        all += piece;
        piece.assign(piece.size(), ' ');
    }
    boost::asio::write(_other, boost::asio::buffer(all));
    std::size_t got = 0;
    boost::asio::async_read(_stream, BuffersOf<boost::asio::mutable_buffer>(pieces),
                            [&](const boost::system::error_code &error, std::size_t bytes)
                            {
                                EXPECT_FALSE(error);
                                got = bytes;
                            });
    _io.run();
    EXPECT_EQ(got, all.size());
    EXPECT_EQ(pieces, Pieces());
}

TEST_F(WebStreamTest, TellsAHandlerThatCannotBeCopiedThatTheOtherEndHasClosed)
{
    _other.close();
    char byte = 0;
    auto expected = std::make_unique<boost::system::error_code>(boost::asio::error::eof);
    bool isEnd = false;
    _stream.async_read_some(boost::asio::buffer(&byte, 1), [expected = std::move(expected), &isEnd](
                                                               const boost::system::error_code &error,
                                                               std::size_t) { isEnd = error == *expected; });
    _io.run();
    EXPECT_TRUE(isEnd);
}

}  // namespace
