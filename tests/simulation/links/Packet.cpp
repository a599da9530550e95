#include "Packet.h"

#include <rabit/gateway/links/LinkFrameCodec.h>

#include <limits>
#include <sstream>

namespace Rabit::Sim
{

namespace
{

constexpr std::uint64_t Impossible = std::numeric_limits<std::uint64_t>::max();

void SpoilAck(LinkAck &ack, SimRandom &random)
{
    switch (random.Between(0, 3))
    {
        case 0:
            ack.Link = 0;
            break;
        case 1:
            ack.Cumulative = Impossible;
            break;
        case 2:
            ack.Open = false;
            ack.Cumulative = 1;
            break;
        default:
            ack.Open = true;
            ack.Oldest = ack.Cumulative + 2;
            break;
    }
}

void SpoilData(LinkData &data, SimRandom &random)
{
    static const std::string longName(300, 't');
    switch (random.Between(0, 7))
    {
        case 0:
            data.Link = 0;
            break;
        case 1:
            data.Items.clear();
            break;
        case 2:
            data.Items.back().Flags = 0xf0;
            break;
        case 3:
            data.Items.back().TtlLeft = -7;
            break;
        case 4:
            data.Oldest = data.Items.front().Sequence + 1;
            break;
        case 5:
            data.Items.back().Sequence = data.Items.back().Through = Impossible;
            break;
        case 6:
            data.Items.push_back(data.Items.front());
            break;
        default:
            data.Items.back().Type = longName;
            break;
    }
}

void SpoilHead(LinkFrame &frame, SimRandom &random)
{
    switch (random.Between(0, 4))
    {
        case 0:
            frame.Version = LinkVersion + 1;
            break;
        case 1:
            frame.Time = -5;
            break;
        case 2:
            frame.Echo.HeldFor = std::numeric_limits<std::int64_t>::max();
            break;
        case 3:
            frame.Source = {};
            break;
        default:
            frame.Short = false;
            frame.SenderLife = random.Chance(0.5) ? 0 : Impossible;
            break;
    }
}

}  // namespace

void Spoil(LinkFrame &frame, SimRandom &random)
{
    const double kind = random.Unit();
    if (frame.HasData && kind < 0.6)
    {
        SpoilData(frame.Data, random);
    }
    else if (!frame.Acks.empty() && kind < 0.8)
    {
        SpoilAck(frame.Acks.back(), random);
    }
    else
    {
        SpoilHead(frame, random);
    }
}

std::string Describe(const Packet &packet)
{
    std::ostringstream out;
    out << 'n' << packet.From << " -> n" << packet.To << ' ' << packet.Bytes.size() << " B";
    LinkFrame frame;
    if (!LinkFrameCodec::Decode(packet.Bytes, frame))
    {
        out << " no frame";
        return out.str();
    }
    if (!frame.Short)
    {
        out << std::hex << " s_inc " << frame.SenderLife << " r_inc " << frame.ReceiverLife << std::dec;
    }
    out << (frame.Ask ? " asks" : "") << " time " << frame.Time / 1000 << " echo " << frame.Echo.Time / 1000
        << " held " << frame.Echo.HeldFor / 1000;
    for (const LinkAck &ack : frame.Acks)
    {
        out << " ACK " << ack.Link << (ack.Open ? "" : " closed") << " cum " << ack.Cumulative << " from "
            << ack.Oldest << " held " << std::hex << ack.Held[0] << std::dec << " credit " << ack.Credit;
    }
    if (frame.HasData)
    {
        out << " DATA " << frame.Data.Link << '/' << frame.Data.Queue << " oldest " << frame.Data.Oldest;
        for (const LinkItem &item : frame.Data.Items)
        {
            out << ' ' << item.Sequence;
            if (item.Through != item.Sequence)
            {
                out << '-' << item.Through;
            }
            out << ((item.Flags & LinkFlagSkip) != 0 ? "s" : "")
                << ((item.Flags & LinkFlagFirst) != 0 ? "f" : "")
                << ((item.Flags & LinkFlagLast) != 0 ? "l" : "") << '(' << item.Payload.size() << ')';
        }
    }
    return out.str();
}

}  // namespace Rabit::Sim
