#include <rabit/RabitLog.h>
#include <rabit/node/TcpServer.h>

#include <chrono>
#include <exception>
#include <utility>

namespace Rabit
{
namespace
{

constexpr std::chrono::milliseconds PauseAfterFailure{100};

}  // namespace

TcpServer::TcpServer(const Endpoint &endpoint)
{
    _acceptor.open(endpoint.protocol());
    _acceptor.set_option(boost::asio::ip::tcp::acceptor::reuse_address(true));
    _acceptor.bind(endpoint);
    _acceptor.listen();
    _address = _acceptor.local_endpoint();
}

TcpServer::~TcpServer()
{
    if (_thread.joinable())
    {
        _io.stop();
        _thread.join();
    }
}

void TcpServer::Start(std::string name, std::function<void(Socket socket)> take)
{
    _take = std::move(take);
    Accept();
    _thread = std::thread([this, name = std::move(name)] { Run(name); });
}

void TcpServer::Accept()
{
    _acceptor.async_accept(
        [this](const boost::system::error_code &error, Socket socket)
        {
            if (error)
            {
                // For instance, no file descriptors are left. Trying again at once would keep the
                // processor busy.
                _pause.expires_after(PauseAfterFailure);
                _pause.async_wait([this](const boost::system::error_code &) { Accept(); });
                return;
            }
            Accept();
            _take(std::move(socket));
        });
}

void TcpServer::Run(const std::string &name)
{
    while (!_io.stopped())
    {
        try
        {
            _io.run();
        }
        catch (const std::exception &error)
        {
            RabitLog::Write(RabitLogLevel::Error, name + " goes on after: " + error.what());
        }
    }
}

}  // namespace Rabit
