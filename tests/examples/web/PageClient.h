// A browser's part of the WebSocket, for tests.
#pragma once

#include <boost/asio/ip/tcp.hpp>

#include <memory>
#include <optional>
#include <string>

namespace GroundTest
{

// Opens the WebSocket of a server. A wait that hangs fails. Boost.Beast, which takes long to compile, stays
// in PageClient.cpp.
class PageClient
{
public:
    // `cookies` is the value of the cookie header. With it the client speaks TLS, and accepts every
    // certificate.
    explicit PageClient(const boost::asio::ip::tcp::endpoint &server,
                        std::optional<std::string> cookies = {});
    ~PageClient();
    PageClient(const PageClient &) = delete;
    PageClient &operator=(const PageClient &) = delete;

    // Returns the server's status for the upgrade; 101 if the WebSocket opened, 0 if the server closed the
    // connection.
    unsigned Open(const std::string &origin = {}, const std::string &host = {},
                  const std::string &target = "/live");
    // Returns the next text; nothing if the connection has ended or nothing comes.
    std::optional<std::string> Next();
    bool Send(const std::string &text, bool asText = true);
    // Returns the next text, and answers it with `seen`.
    std::optional<std::string> NextSeen();

private:
    class Connection;
    const std::unique_ptr<Connection> _connection;
};

}  // namespace GroundTest
