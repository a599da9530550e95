#include "live/LiveServer.h"

#include <rabit/RabitLog.h>

#include <boost/asio/post.hpp>

#include <exception>
#include <random>
#include <utility>

#include "FleetSession.h"
#include "live/LiveContext.h"
#include "live/LiveSession.h"

namespace Rabit::Tool
{
namespace
{

using boost::asio::ip::tcp;

constexpr std::chrono::milliseconds PauseAfterFailure{100};

std::string RandomId()
{
    std::random_device random;
    return std::to_string(random()) + "-" + std::to_string(random());
}

}  // namespace

LiveServer::LiveServer(const Settings &settings) : _context(new LiveContext{settings, RandomId(), {}, {}})
{
    Listen();
    Accept();
    _thread = std::thread([this] { Serve(); });
}

LiveServer::~LiveServer()
{
    _io.stop();
    _thread.join();
}

std::uint32_t LiveServer::AddChannel(LiveProtocol::Channel channel, bool isState)
{
    channel.Id = ++_lastChannel;
    boost::asio::post(_io,
                      [this, channel, isState]
                      {
                          _context->Channels[channel.Id] = {channel, isState, nullptr};
                          for (LiveSession *session : Sessions())
                          {
                              session->Offer(channel);
                          }
                      });
    return channel.Id;
}

void LiveServer::Show(std::uint32_t channel, std::uint64_t time, std::vector<std::uint8_t> bytes)
{
    const std::size_t size = bytes.size() + sizeof(LiveValue);
    if (_backlog.fetch_add(size) + size > LargestBacklog)
    {
        _backlog -= size;
        ++_context->Dropped;
        return;
    }
    auto value = std::make_shared<const LiveValue>(LiveValue{channel, time, std::move(bytes)});
    boost::asio::post(_io,
                      [this, size, value = std::move(value)]
                      {
                          _backlog -= size;
                          LiveContext::Offered &offered = _context->Channels.at(value->Channel);
                          offered.Last = offered.IsState ? value : nullptr;
                          for (LiveSession *session : Sessions())
                          {
                              session->Show(value);
                          }
                      });
}

void LiveServer::Listen()
{
    try
    {
        _acceptor.open(_context->Settings.Endpoint.protocol());
        _acceptor.set_option(tcp::acceptor::reuse_address(true));
        _acceptor.bind(_context->Settings.Endpoint);
        _acceptor.listen();
        _endpoint = _acceptor.local_endpoint();
    }
    catch (const boost::system::system_error &error)
    {
        throw NetworkError(
            "viewers cannot be served at " + _context->Settings.Endpoint.address().to_string() + ":" +
            std::to_string(_context->Settings.Endpoint.port()) + ": " + error.code().message());
    }
}

void LiveServer::Accept()
{
    _acceptor.async_accept(
        [this](const boost::system::error_code &error, tcp::socket socket)
        {
            if (error)
            {
                // For instance, no file descriptors are left. Trying again at once would keep the
                // processor busy.
                _pause.expires_after(PauseAfterFailure);
                _pause.async_wait([this](const boost::system::error_code &) { Accept(); });
                return;
            }
            std::make_shared<LiveSession>(std::move(socket), *_context)->Begin();
            Accept();
        });
}

void LiveServer::Serve()
{
    while (!_io.stopped())
    {
        try
        {
            _io.run();
        }
        catch (const std::exception &error)
        {
            RabitLog::Write(RabitLogLevel::Error,
                            std::string("the server of viewers goes on after: ") + error.what());
        }
    }
}

// A copy, because a session that cannot be written to removes itself.
std::vector<LiveSession *> LiveServer::Sessions() const
{
    return {_context->Sessions.begin(), _context->Sessions.end()};
}

LiveServer::Counters LiveServer::Count() const
{
    return {_context->Viewers, _context->Shown, _context->Dropped};
}

}  // namespace Rabit::Tool
