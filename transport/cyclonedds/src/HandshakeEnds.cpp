#include "HandshakeEnds.h"

#include <algorithm>
#include <string_view>

#include "common/RtpsSubmessages.h"

namespace Rabit::Cyclone
{

namespace
{

// OMG DDS Security 1.1, 9.3.2.5: names of the messages of a handshake.
constexpr std::string_view Reply = "DDS:Auth:PKI-DH:1.0+Reply";
constexpr std::string_view Final = "DDS:Auth:PKI-DH:1.0+Final";
constexpr std::size_t PrefixAt = 8;  // in the header
constexpr std::uint8_t InfoDestination = 0x0e;

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
    VisitSubmessages(datagram,
                     [&](const RtpsSubmessage<const std::uint8_t> &submessage)
                     {
                         if (submessage.Kind == InfoDestination && submessage.Body().size() >= Peer().size())
                         {
                             std::copy_n(submessage.Body().begin(), Peer().size(), to.emplace().begin());
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
    if (datagram.size() < RtpsHeaderSize || !Contains(datagram, Reply))
    {
        return;
    }
    const auto from = datagram.subspan(PrefixAt, Peer().size());
    const std::lock_guard lock(_mutex);
    const auto found = std::find_if(
        _ends.begin(), _ends.end(),
        [&](const End &end) { return std::equal(from.begin(), from.end(), end.To.begin(), end.To.end()); });
    if (found != _ends.end())
    {
        found->Due = now + Delay;
    }
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
