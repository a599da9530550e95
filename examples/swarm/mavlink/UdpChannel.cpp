#include "UdpChannel.h"

#include <rabit/RabitLog.h>

#include <boost/asio/buffer.hpp>

#include <sstream>
#include <string>
#include <utility>

namespace Swarm
{
namespace
{

constexpr int MostDroppedAtOnce = 200;

std::string TextOf(const UdpChannel::Endpoint &endpoint)
{
    std::ostringstream text;
    text << endpoint;
    return text.str();
}

}  // namespace

UdpChannel::UdpChannel(const Endpoint &local)
{
    _socket.open(local.protocol());
    _socket.bind(local);
    _socket.non_blocking(true);
}

std::size_t UdpChannel::Receive(std::span<std::uint8_t> buffer, Time now)
{
    if (now != _calledAt)
    {
        _droppedNow = 0;
        _heardAt += now - _calledAt > Standstill ? now - _calledAt : Time(0);
        _calledAt = now;
    }
    for (; _droppedNow < MostDroppedAtOnce; ++_droppedNow)
    {
        boost::system::error_code error;
        Endpoint sender;
        const std::size_t size =
            _socket.receive_from(boost::asio::buffer(buffer.data(), buffer.size()), sender, 0, error);
        if (error)
        {
            return 0;
        }
        if (size > 0 && IsPeer(sender, now))
        {
            return size;
        }
    }
    return 0;
}

bool UdpChannel::IsPeer(const Endpoint &sender, Time now)
{
    if (_peer.port() == 0 || (sender != _peer && now - _heardAt > PeerSilentAfter))
    {
        _peer = sender;
        _tellsOfOthers = true;
        Rabit::RabitLog::Write(Rabit::RabitLogLevel::Info, "autopilot: MAVLink comes from " + TextOf(_peer));
    }
    if (sender == _peer)
    {
        _heardAt = now;
        return true;
    }
    ++_dropped;
    if (std::exchange(_tellsOfOthers, false))
    {
        Rabit::RabitLog::Write(Rabit::RabitLogLevel::Warning, "autopilot: datagrams from " + TextOf(sender) +
                                                                  " are dropped: the autopilot is " +
                                                                  TextOf(_peer) +
                                                                  "; let no other program send to this port");
    }
    return false;
}

bool UdpChannel::Send(std::span<const std::uint8_t> bytes)
{
    boost::system::error_code error;
    return _peer.port() != 0 &&
           _socket.send_to(boost::asio::buffer(bytes.data(), bytes.size()), _peer, 0, error) ==
               bytes.size() &&
           !error;
}

}  // namespace Swarm
