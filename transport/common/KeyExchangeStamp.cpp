#include "common/KeyExchangeStamp.h"

#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"

namespace Rabit
{

namespace
{

// One of the kinds that are left to the vendors, and a word of our own, so that no other one is taken for it.
constexpr Rtps::SubmessageKind Kind{0x90};
constexpr std::uint32_t Word = 0x504d5453;
constexpr std::size_t BodySize = KeyExchangeStamp::Size - Rtps::SubmessageHeaderSize;

}  // namespace

void KeyExchangeStamp::AppendTo(std::vector<std::uint8_t> &datagram) const
{
    Rtps::AppendSubmessageHeader(datagram, Kind, BodySize);
    Rtps::Append(datagram, Word, sizeof(Word));
    Rtps::Append(datagram, SentAt, sizeof(SentAt));
    Rtps::Append(datagram, Echo, sizeof(Echo));
}

std::optional<KeyExchangeStamp> KeyExchangeStamp::Of(std::span<const std::uint8_t> datagram)
{
    if (datagram.size() < Rtps::RtpsHeaderSize + Size)
    {
        return std::nullopt;
    }
    Rtps::RtpsReader reader(datagram.last(Size), true);
    const auto head = reader.Bytes(Rtps::SubmessageHeaderSize);
    if (Rtps::SubmessageKind{head[0]} != Kind || head[1] != Rtps::LittleEndianFlag || head[2] != BodySize ||
        head[3] != 0 || reader.U32() != Word)
    {
        return std::nullopt;
    }
    const std::uint32_t sentAt = reader.U32();
    return KeyExchangeStamp{.SentAt = sentAt, .Echo = reader.U32()};
}

}  // namespace Rabit
