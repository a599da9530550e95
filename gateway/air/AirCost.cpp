#include <rabit/gateway/AirCost.h>

#include <algorithm>

namespace Rabit
{
namespace
{

// Submessages begin at multiples of four bytes, and their contents are padded to that.
std::size_t Padded(std::size_t bytes)
{
    return (bytes + 3) / 4 * 4;
}

}  // namespace

// Bytes before the submessage with the data, from the RTPS header on.
std::size_t AirCost::Before(bool directed)
{
    return RtpsHeader + InfoTimestamp + (directed ? InfoDestination : 0);
}

std::size_t AirCost::Of(std::size_t body, Readers readers) const
{
    const std::size_t payload = Padded(Encapsulation + body);
    const std::size_t whole = Before(readers.Directed) + Data + payload;
    if (whole <= _maxDatagram)
    {
        return readers.Destinations * (IpAndUdp + whole);
    }
    const std::size_t headers = Before(readers.Directed) + DataFragment;
    const std::size_t room = _maxDatagram > headers + 4 ? (_maxDatagram - headers) / 4 * 4 : 4;
    const std::size_t datagrams = (payload + room - 1) / room;
    return readers.Destinations * (datagrams * (IpAndUdp + headers) + payload);
}

std::size_t AirCost::OfFirst(std::size_t body, Readers readers) const
{
    return std::min(Of(body, readers), readers.Destinations * (IpAndUdp + _maxDatagram));
}

std::size_t AirCost::BodyWithin(std::size_t bytesOnAir, bool directed) const
{
    const std::size_t datagram =
        std::min(bytesOnAir > IpAndUdp ? bytesOnAir - IpAndUdp : 0, _maxDatagram) / 4 * 4;
    const std::size_t headers = Before(directed) + Data + Encapsulation;
    return datagram > headers ? datagram - headers : 0;
}

}  // namespace Rabit
