// A browser's part of the WebSocket, for tests.
#pragma once

#include <boost/asio/ip/tcp.hpp>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace GroundTest
{

// Opens the WebSocket of a server. Every wait ends after Patience at the latest: then it has failed.
// Boost.Beast, which takes long to compile, stays in PageClient.cpp.
class PageClient
{
public:
    static constexpr std::chrono::seconds Patience{20};

    // cookies: as its header says them; with them it speaks TLS, and believes every certificate.
    explicit PageClient(const boost::asio::ip::tcp::endpoint &server,
                        std::optional<std::string> cookies = {});
    ~PageClient();
    PageClient(const PageClient &) = delete;
    PageClient &operator=(const PageClient &) = delete;

    // The status with which the server answers the upgrade; 101 if it opened, 0 if it closed the connection.
    unsigned Open(const std::string &origin = {}, const std::string &host = {},
                  const std::string &target = "/live");
    // The next text; nothing if the connection has ended or nothing comes.
    std::optional<std::string> Next();
    bool Send(const std::string &text, bool asText = true);
    // What the next text is when this one is answered with `seen`.
    std::optional<std::string> NextSeen();

private:
    class Connection;
    const std::unique_ptr<Connection> _connection;
};

}  // namespace GroundTest
