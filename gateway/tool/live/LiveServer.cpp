#include "live/LiveServer.h"

#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>

#include <random>
#include <stdexcept>
#include <utility>

#include "live/LiveContext.h"
#include "live/LiveSession.h"

namespace Rabit::Tool
{
namespace
{

std::string RandomId()
{
    std::random_device random;
    return std::to_string(random()) + "-" + std::to_string(random());
}

}  // namespace

LiveServer::LiveServer(const Settings &settings) : _context(new LiveContext{settings, RandomId(), {}, {}})
{
    if (!settings.Token.empty())
    {
        _context->Guard.emplace(settings.Token, "The server of viewers");
    }
    try
    {
        _server = std::make_unique<TcpServer>(settings.Endpoint);
    }
    catch (const boost::system::system_error &error)
    {
        const bool isTaken = error.code() == boost::asio::error::address_in_use;
        throw std::runtime_error("viewers cannot be served at " + settings.Endpoint.address().to_string() +
                                 ":" + std::to_string(settings.Endpoint.port()) + ": " +
                                 (isTaken ? "another program has that port; choose another one with --port"
                                          : error.code().message()));
    }
    _server->Start("the server of viewers", [this](TcpServer::Socket socket)
                   { std::make_shared<LiveSession>(std::move(socket), *_context)->Begin(); });
}

LiveServer::~LiveServer() = default;

std::uint32_t LiveServer::AddChannel(LiveProtocol::Channel channel, bool isState)
{
    channel.Id = ++_lastChannel;
    boost::asio::post(_server->Io(),
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
    boost::asio::post(_server->Io(),
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
