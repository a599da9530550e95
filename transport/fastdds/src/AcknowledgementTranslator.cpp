#include "AcknowledgementTranslator.h"

#include <algorithm>

namespace Rabit::FastDds
{

namespace
{

// RTPS 2.3, 8.3.3 and 9.4.5
constexpr std::size_t HeaderSize = 20;
constexpr std::size_t PrefixAt = 8;
constexpr std::size_t SubmessageHeaderSize = 4;
constexpr std::uint8_t Pad = 0x01;
constexpr std::uint8_t AckNack = 0x06;
constexpr std::uint8_t InfoTimestamp = 0x09;
constexpr std::uint8_t InfoSource = 0x0c;
constexpr std::uint8_t NackFrag = 0x12;
// DDS Security 1.1, 7.3.6.2
constexpr std::uint8_t FirstSecure = 0x30;
constexpr std::uint8_t LastSecure = 0x35;
constexpr std::uint8_t LittleEndian = 0x01;
constexpr std::uint8_t Final = 0x02;
// AckNack and NackFrag consist of reader, writer, a sequence number, a set, and the count.
constexpr std::size_t EntitiesSize = 8;
constexpr std::size_t SequenceAt = 8;
constexpr std::size_t AckNackBitsAt = 16;
constexpr std::size_t NackFragBitsAt = 20;
constexpr std::size_t CountSize = 4;
// A count farther behind the last one is not merely late: one of the two was forged, and the honest ones go
// on from the lower.
constexpr std::uint32_t FarthestBehind = 16;

std::uint32_t Read(std::span<const std::uint8_t> bytes, bool littleEndian)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        value = value << 8 | bytes[littleEndian ? bytes.size() - 1 - i : i];
    }
    return value;
}

void Write(std::span<std::uint8_t> bytes, std::uint32_t value, bool littleEndian)
{
    for (std::size_t i = 0; i < bytes.size(); ++i, value >>= 8)
    {
        bytes[littleEndian ? i : bytes.size() - 1 - i] = static_cast<std::uint8_t>(value);
    }
}

}  // namespace

void AcknowledgementTranslator::Translate(std::span<std::uint8_t> datagram)
{
    Prefix sender;
    std::copy_n(datagram.begin() + PrefixAt, sender.size(), sender.begin());
    auto rest = datagram.subspan(HeaderSize);
    while (!rest.empty())
    {
        const std::uint8_t kind = rest[0];
        const std::uint8_t flags = rest[1];
        const bool littleEndian = (flags & LittleEndian) != 0;
        std::size_t length = Read(rest.subspan(2, 2), littleEndian);
        if (kind >= FirstSecure && kind <= LastSecure)
        {
            return;  // the remaining submessages may be signed
        }
        rest = rest.subspan(SubmessageHeaderSize);
        if (length == 0 && kind != Pad && kind != InfoTimestamp)
        {
            length = rest.size();  // 9.4.5.1.3: it extends to the end of the message
        }
        if (kind == InfoSource)
        {
            // Sender of the following submessages; 9.4.5.9
            std::copy_n(rest.begin() + PrefixAt, sender.size(), sender.begin());
        }
        if (kind == AckNack || kind == NackFrag)
        {
            const auto body = rest.first(length);
            const auto number = [&](std::size_t at) { return Read(body.subspan(at, 4), littleEndian); };
            const std::size_t bitsAt = kind == AckNack ? AckNackBitsAt : NackFragBitsAt;
            const std::uint32_t bits = number(bitsAt);
            const std::size_t countAt = bitsAt + 4 + 4 * std::size_t{(bits + 31) / 32};
            // The reader has all samples before the base.
            const bool something = number(SequenceAt) != 0 || number(SequenceAt + 4) > 1;
            Exchange exchange;
            std::copy_n(body.begin(), EntitiesSize, exchange.begin());
            exchange[EntitiesSize] = kind;
            const bool askingForAll = kind == AckNack && !something && bits == 0 && (flags & Final) == 0;
            if (askingForAll)
            {
                if (HadSomething(sender, exchange))
                {
                    Forget(sender);
                }
                Write(body.subspan(SequenceAt + 4, 4), 0, littleEndian);
            }
            const auto count = CountOf(sender, exchange, number(countAt), kind == AckNack && something);
            Write(body.subspan(countAt, CountSize), count, littleEndian);
        }
        rest = rest.subspan(length);
    }
}

bool AcknowledgementTranslator::HadSomething(const Prefix &sender, const Exchange &exchange) const
{
    const auto known = _exchanges.find({sender, exchange});
    return known != _exchanges.end() && known->second.HadSomething;
}

std::uint32_t AcknowledgementTranslator::CountOf(const Prefix &sender, const Exchange &exchange,
                                                 std::uint32_t theirs, bool something)
{
    const std::pair key{sender, exchange};
    auto known = _exchanges.find(key);
    if (known == _exchanges.end())
    {
        if (_exchanges.size() >= MostExchanges)
        {
            _exchanges.clear();
            _floor = _highest;
        }
        known = _exchanges.emplace(key, Counts{theirs, _floor + 1, something}).first;
    }
    else if (known->second.Theirs - theirs > FarthestBehind)  // or ahead: unsigned
    {
        known->second = {theirs, known->second.Ours + 1, something};
    }
    _highest = std::max(_highest, known->second.Ours);
    return known->second.Ours;
}

// Its other readers, and its fragment requests for every sample, start new counts as well.
void AcknowledgementTranslator::Forget(const Prefix &sender)
{
    const auto first = _exchanges.lower_bound({sender, {}});
    auto last = first;
    while (last != _exchanges.end() && last->first.first == sender)
    {
        ++last;
    }
    _exchanges.erase(first, last);
    _floor = _highest;
}

}  // namespace Rabit::FastDds
