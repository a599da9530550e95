#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <functional>
#include <string>
#include <thread>

namespace Rabit
{

// Takes TCP connections on a thread of its own, which also runs what they wait for. For a program that serves
// viewers or pages.
class TcpServer
{
public:
    using Endpoint = boost::asio::ip::tcp::endpoint;
    using Socket = boost::asio::ip::tcp::socket;

    // Listens from here on, so that a port in use is reported before anything else starts; connections wait
    // until Start. Throws boost::system::system_error.
    explicit TcpServer(const Endpoint &endpoint);
    // Ends the thread, and then all that waits in Io().
    ~TcpServer();
    TcpServer(const TcpServer &) = delete;
    TcpServer &operator=(const TcpServer &) = delete;

    // Begins to take connections; each goes to `take`, on the server's thread. An exception there is logged,
    // and ends nothing; `name` says in the log what this server is. To be called once.
    void Start(std::string name, std::function<void(Socket socket)> take);
    bool IsStarted() const { return _thread.joinable(); }

    // The address; if port 0 was asked for, with the chosen port.
    const Endpoint &Address() const { return _address; }
    // Runs on the server's thread alone.
    boost::asio::io_context &Io() { return _io; }

private:
    void Accept();
    void Run(const std::string &name);

    boost::asio::io_context _io{1};
    boost::asio::ip::tcp::acceptor _acceptor{_io};
    boost::asio::steady_timer _pause{_io};
    Endpoint _address;
    std::function<void(Socket socket)> _take;
    std::thread _thread;
};

}  // namespace Rabit
