#include "HandshakeEnds.h"

#include <algorithm>
#include <string_view>

#include "common/RtpsReader.h"

namespace Rabit::Cyclone
{

namespace
{

// OMG DDS Security 1.1, 9.3.2.5: names of the messages of a handshake.
constexpr std::string_view Reply = "DDS:Auth:PKI-DH:1.0+Reply";
constexpr std::string_view Final = "DDS:Auth:PKI-DH:1.0+Final";

bool Contains(std::span<const std::uint8_t> datagram, std::string_view text)
{
    const auto *bytes = reinterpret_cast<const char *>(datagram.data());
    return std::string_view(bytes, datagram.size()).find(text) != std::string_view::npos;
}

}  // namespace

void HandshakeEnds::Sent(std::span<const std::uint8_t> datagram, const RabitCycloneRoute &route)
{
    if (!Contains(datagram, Final))
    {
        return;
    }
    std::optional<Peer> to;
    Rtps::VisitSubmessages(datagram,
                           [&](const Rtps::ConstSubmessage &submessage)
                           {
                               if (submessage.Kind == Rtps::SubmessageKind::InfoDestination &&
                                   submessage.Body().size() >= Peer().size())
                               {
                                   to = Rtps::PrefixOf(submessage.Body());
                               }
                           });
    if (!to)
    {
        return;
    }
    const std::lock_guard lock(_mutex);
    std::erase_if(_ends, [&](const End &end) { return end.To == *to; });
    if (_ends.size() >= MostPeers)
    {
        _ends.pop_front();
    }
    _ends.push_back({*to, {route, {datagram.begin(), datagram.end()}}});
}

void HandshakeEnds::Received(std::span<const std::uint8_t> datagram, TimePoint now)
{
    if (datagram.size() < Rtps::RtpsHeaderSize || !Contains(datagram, Reply))
    {
        return;
    }
    const Peer from = Rtps::PrefixOf(datagram.subspan(Rtps::PrefixAt));
    const std::lock_guard lock(_mutex);
    const auto found =
        std::find_if(_ends.begin(), _ends.end(), [&](const End &end) { return end.To == from; });
    if (found != _ends.end())
    {
        found->Due = now + Delay;
    }
}

void HandshakeEnds::Forget(const Rtps::GuidPrefix &peer)
{
    const std::lock_guard lock(_mutex);
    std::erase_if(_ends, [&](const End &end) { return end.To == peer; });
}

std::vector<HandshakeEnds::Datagram> HandshakeEnds::TakeDue(TimePoint now)
{
    std::vector<Datagram> due;
    const std::lock_guard lock(_mutex);
    for (End &end : _ends)
    {
        if (end.Due && *end.Due <= now)
        {
            due.push_back(end.What);
            end.Due.reset();
        }
    }
    return due;
}

}  // namespace Rabit::Cyclone
