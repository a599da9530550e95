#include "Frame.h"

#include <algorithm>

namespace Rabit::Radio
{
namespace
{

constexpr std::uint16_t Ipv4 = 0x0800;
constexpr std::uint16_t Ipv6 = 0x86dd;
constexpr std::uint16_t Arp = 0x0806;
constexpr std::size_t Ipv4Header = 20;

std::uint16_t Word(const Frame &frame, std::size_t at)
{
    return static_cast<std::uint16_t>(frame[at] << 8 | frame[at + 1]);
}

std::string ProtocolName(const Kind &kind)
{
    if (kind.EtherType == Arp)
    {
        return "arp";
    }
    if (kind.EtherType != Ipv4)
    {
        return std::string("ethertype ").append(std::to_string(kind.EtherType));
    }
    switch (kind.Protocol)
    {
        case 1:
            return "icmp";
        case 2:
            return "igmp";
        case 6:
            return "tcp";
        case 17:
            return "udp";
        default:
            return std::string("ip ").append(std::to_string(kind.Protocol));
    }
}

}  // namespace

bool IsMulticast(const Frame &frame)
{
    return frame.size() >= EthernetHeader && (frame[0] & 1) != 0;
}

MacAddress DestinationOf(const Frame &frame)
{
    MacAddress address{};
    if (frame.size() >= EthernetHeader)
    {
        std::copy_n(frame.begin(), address.size(), address.begin());
    }
    return address;
}

std::size_t IpBytes(const Frame &frame)
{
    if (frame.size() < EthernetHeader)
    {
        return 0;
    }
    const std::uint16_t type = Word(frame, 12);
    return type == Ipv4 || type == Ipv6 ? frame.size() - EthernetHeader : 0;
}

Kind KindOf(const Frame &frame)
{
    Kind kind;
    kind.Multicast = IsMulticast(frame);
    if (frame.size() < EthernetHeader)
    {
        return kind;
    }
    kind.EtherType = Word(frame, 12);
    if (kind.EtherType != Ipv4 || frame.size() < EthernetHeader + Ipv4Header)
    {
        return kind;
    }
    kind.Protocol = frame[EthernetHeader + 9];
    kind.Fragment = (Word(frame, EthernetHeader + 6) & 0x1fff) != 0;
    const std::size_t ports = EthernetHeader + static_cast<std::size_t>(frame[EthernetHeader] & 0xf) * 4;
    if ((kind.Protocol == 6 || kind.Protocol == 17) && !kind.Fragment && frame.size() >= ports + 4)
    {
        kind.Port = Word(frame, ports + 2);
    }
    return kind;
}

std::string NameOf(const Kind &kind)
{
    std::string name = kind.Multicast ? "multicast " : "unicast ";
    name += ProtocolName(kind);
    if (kind.Fragment)
    {
        name += " fragment";
    }
    else if (kind.Port != 0)
    {
        name.append(" ").append(std::to_string(kind.Port));
    }
    return name;
}

}  // namespace Rabit::Radio
