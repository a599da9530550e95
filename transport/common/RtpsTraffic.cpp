#include "common/RtpsTraffic.h"

namespace Rabit
{

namespace
{

// OMG DDSI-RTPS 2.3, 9.4.5
constexpr std::size_t HeaderSize = 20;
constexpr std::size_t SubmessageHeaderSize = 4;
constexpr std::uint8_t Data = 0x15;
constexpr std::uint8_t DataFrag = 0x16;
constexpr std::uint8_t LittleEndian = 0x01;
constexpr std::size_t WriterInData = 8;
constexpr std::size_t WriterElsewhere = 4;
// 9.3.1.2: the two highest bits of an entity's last byte.
constexpr std::uint8_t Builtin = 0xc0;

// ACKNACK, HEARTBEAT, GAP, NACK_FRAG, HEARTBEAT_FRAG
bool NamesWriter(std::uint8_t kind)
{
    return (kind >= 0x06 && kind <= 0x08) || kind == 0x12 || kind == 0x13;
}

}  // namespace

bool IsOfSamples(std::span<const std::uint8_t> head)
{
    std::size_t at = HeaderSize;
    while (at + SubmessageHeaderSize <= head.size())
    {
        const std::uint8_t kind = head[at];
        const bool isData = kind == Data || kind == DataFrag;
        if (isData || NamesWriter(kind))
        {
            const std::size_t last =
                at + SubmessageHeaderSize + (isData ? WriterInData : WriterElsewhere) + 3;
            return last < head.size() && (head[last] & Builtin) != Builtin;
        }
        const bool littleEndian = (head[at + 1] & LittleEndian) != 0;
        const std::size_t first = head[at + 2];
        const std::size_t second = head[at + 3];
        at += SubmessageHeaderSize + (littleEndian ? second << 8 | first : first << 8 | second);
    }
    return false;
}

}  // namespace Rabit
