#include "Packet.h"

#include <limits>
#include <sstream>

namespace Rabit::Sim
{

namespace
{

constexpr std::uint64_t Impossible = std::numeric_limits<std::uint64_t>::max();

void SpoilMessage(Test::StoredHello &hello, SimRandom &random)
{
    switch (random.Between(0, 3))
    {
        case 0:
            hello.Fields.Version = 0;
            break;
        case 1:
            hello.Fields.Incarnation = random.Chance(0.5) ? 0 : Impossible;
            break;
        case 2:
            hello.Fields.YourIncarnation = Impossible;
            break;
        default:
            hello.Source.clear();
            break;
    }
}

void SpoilMessage(Test::StoredAck &ack, SimRandom &random)
{
    switch (random.Between(0, 4))
    {
        case 0:
            ack.Fields.Version = 77;
            break;
        case 1:
            ack.Fields.ReceiverIncarnation = random.Chance(0.5) ? 0 : Impossible;
            break;
        case 2:
            ack.Fields.SenderIncarnation = Impossible;
            break;
        case 3:
            ack.Fields.SenderIncarnation = 0;
            ack.Fields.Cumulative = 1;
            break;
        default:
            ack.Fields.Time = -5;
            break;
    }
}

void SpoilMessage(Test::StoredData &data, SimRandom &random)
{
    switch (random.Between(0, 7))
    {
        case 0:
            data.Fields.Version = 3;
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
            data.Fields.Base = data.Fields.First + 1;
            break;
        case 5:
            data.Fields.First = Impossible;
            break;
        case 6:
            data.Fields.ReceiverIncarnation = Impossible;
            break;
        default:
            data.Items.back().Type.assign(300, 't');
            break;
    }
}

void Write(std::ostream &out, const Test::StoredHello &hello)
{
    out << "HELLO inc " << std::hex << hello.Fields.Incarnation << " your " << hello.Fields.YourIncarnation
        << std::dec << " r_time " << hello.Fields.Time;
}

void Write(std::ostream &out, const Test::StoredAck &ack)
{
    const LinkAck &k = ack.Fields;
    out << "ACK " << ack.Queue << std::hex << " r_inc " << k.ReceiverIncarnation << " s_inc "
        << k.SenderIncarnation << " your " << k.YourIncarnation << " bits " << k.Delivered[0] << '/'
        << k.Refused[0] << std::dec << " cum " << k.Cumulative << " credit " << k.Credit << " r_time "
        << k.Time;
}

void Write(std::ostream &out, const Test::StoredData &data)
{
    const LinkData &d = data.Fields;
    out << "DATA " << data.Queue << std::hex << " s_inc " << d.SenderIncarnation << " r_inc "
        << d.ReceiverIncarnation << std::dec << " base " << d.Base << " first " << d.First << " count "
        << data.Items.size() << " flags " << int{data.Items.empty() ? std::uint8_t{0} : data.Items[0].Flags}
        << " ttl " << (data.Items.empty() ? 0 : data.Items[0].TtlLeft) << " echo " << d.Echo.Time << " held "
        << d.Echo.HeldFor;
}

}  // namespace

void Spoil(Packet &packet, SimRandom &random)
{
    std::visit([&](auto &message) { SpoilMessage(message, random); }, packet.Message);
}

std::uint64_t IncarnationOf(const Packet &packet)
{
    struct Visitor
    {
        std::uint64_t operator()(const Test::StoredHello &hello) const { return hello.Fields.Incarnation; }
        std::uint64_t operator()(const Test::StoredAck &ack) const { return ack.Fields.ReceiverIncarnation; }
        std::uint64_t operator()(const Test::StoredData &data) const { return data.Fields.SenderIncarnation; }
    };
    return std::visit(Visitor{}, packet.Message);
}

std::string Describe(const Packet &packet)
{
    std::ostringstream out;
    out << 'n' << packet.From << " -> n" << packet.To << ' ';
    std::visit([&](const auto &message) { Write(out, message); }, packet.Message);
    return out.str();
}

}  // namespace Rabit::Sim
