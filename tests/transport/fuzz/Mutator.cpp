#include "Mutator.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace
{

constexpr std::size_t HeaderSize = 20;
constexpr std::size_t PrefixOffset = 8;
constexpr std::size_t PrefixSize = 12;
constexpr std::size_t SubmessageHeaderSize = 4;
constexpr std::uint8_t Data = 0x15;
constexpr std::uint8_t DataFrag = 0x16;
// Upper bound of a datagram's size, in bytes.
constexpr std::size_t Largest = 65000;

constexpr std::array<std::uint8_t, 22> Kinds = {0x01, 0x06, 0x07, 0x08, 0x09, 0x0c, 0x0d, 0x0e,
                                                0x0f, 0x12, 0x13, 0x15, 0x16, 0x30, 0x31, 0x32,
                                                0x33, 0x34, 0x35, 0x80, 0x81, 0xff};
constexpr std::array<std::uint32_t, 15> Entities = {
    0,          0x000001c1, 0x000100c2, 0x000100c7, 0x000003c2, 0x000003c7, 0x000004c2, 0x000200c2,
    0x000200c7, 0x000201c3, 0x000201c4, 0xff0202c3, 0xff0202c4, 0xff0101c2, 0xff0003c2};
constexpr std::array<std::uint16_t, 31> Parameters = {
    0x0000, 0x0001, 0x0002, 0x0005, 0x0007, 0x000f, 0x001a, 0x001b, 0x001d, 0x0029, 0x002c,
    0x002e, 0x002f, 0x0031, 0x0032, 0x0035, 0x0050, 0x0055, 0x0059, 0x005a, 0x0062, 0x0069,
    0x0070, 0x0072, 0x0073, 0x8006, 0x1001, 0x1002, 0x1004, 0x1005, 0x1006};

}  // namespace

void Mutator::Learn(const std::vector<Datagram> &datagrams)
{
    _originals = datagrams;
    for (const auto &datagram : datagrams)
    {
        const Datagram prefix(datagram.begin() + PrefixOffset, datagram.begin() + HeaderSize);
        if (std::find(_prefixes.begin(), _prefixes.end(), prefix) == _prefixes.end())
        {
            _prefixes.push_back(prefix);
        }
    }
}

Datagram Mutator::Next()
{
    Datagram datagram = _originals[Below(_originals.size())];
    for (std::size_t times = 1 + Below(4); times > 0; --times)
    {
        Damage(datagram);
    }
    datagram.resize(std::min(datagram.size(), Largest));
    return datagram;
}

void Mutator::Damage(Datagram &datagram)
{
    if (datagram.size() < HeaderSize + SubmessageHeaderSize)
    {
        Splice(datagram);
        return;
    }
    switch (Below(13))
    {
        case 12:
            SpeakForAnother(datagram);
            break;
        case 0:
        case 1:
        case 2:
            DamageBytes(datagram);
            break;
        case 3:
            DamageSize(datagram);
            break;
        case 4:
        case 5:
            Splice(datagram);
            break;
        case 6:
            DamageIdentity(datagram);
            break;
        default:
            DamagePart(datagram);
            break;
    }
}

std::uint32_t Mutator::Number()
{
    constexpr std::array<std::uint32_t, 12> Edges = {
        0, 1, 2, 255, 256, 257, 0xffff, 0x10000, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff};
    switch (Below(3))
    {
        case 0:
            return Edges[Below(Edges.size())];
        case 1:
            return 1u << Below(32);
        default:
            return static_cast<std::uint32_t>(_random() >> Below(32));
    }
}

void Mutator::Put(Datagram &datagram, std::size_t at, std::size_t size, bool littleEndian,
                  std::uint64_t value)
{
    for (std::size_t i = 0; i < size && at + i < datagram.size(); ++i)
    {
        datagram[at + i] = static_cast<std::uint8_t>(value >> (8 * (littleEndian ? i : size - 1 - i)));
    }
}

std::vector<Mutator::Part> Mutator::PartsOf(const Datagram &datagram)
{
    std::vector<Part> parts;
    std::size_t at = HeaderSize;
    while (at + SubmessageHeaderSize <= datagram.size())
    {
        Part part{at, 0, (datagram[at + 1] & 1) != 0};
        const std::size_t low = datagram[at + (part.LittleEndian ? 2 : 3)];
        const std::size_t high = datagram[at + (part.LittleEndian ? 3 : 2)];
        const std::size_t length = low | high << 8;
        part.End = std::min(datagram.size(), at + SubmessageHeaderSize + length);
        parts.push_back(part);
        at = part.End;
    }
    return parts;
}

void Mutator::DamageBytes(Datagram &datagram)
{
    const std::size_t at = Below(datagram.size());
    switch (Below(3))
    {
        case 0:
            datagram[at] = static_cast<std::uint8_t>(datagram[at] ^ (1u << Below(8)));
            break;
        case 1:
            datagram[at] = static_cast<std::uint8_t>(_random());
            break;
        default:
            Put(datagram, at & ~std::size_t{3}, 4, OneIn(2), Number());
            break;
    }
}

void Mutator::DamagePart(Datagram &datagram)
{
    const auto parts = PartsOf(datagram);
    if (parts.empty())
    {
        return;
    }
    const Part part = parts[Below(parts.size())];
    switch (Below(8))
    {
        case 0:
            datagram[part.Begin] = Kinds[Below(Kinds.size())];
            break;
        case 1:
            datagram[part.Begin + 1] = static_cast<std::uint8_t>(datagram[part.Begin + 1] ^ (1u << Below(8)));
            break;
        case 2:
        {
            const std::size_t length = part.End - part.Begin - SubmessageHeaderSize;
            const std::array<std::size_t, 6> lengths = {
                0, length + 1, length + 4, length > 0 ? length - 1 : 0, length / 2, Below(65536)};
            Put(datagram, part.Begin + 2, 2, part.LittleEndian, lengths[Below(lengths.size())]);
            break;
        }
        case 3:
        case 4:
            DamageParameters(datagram, part);
            break;
        default:
            DamageNumbers(datagram, part);
            break;
    }
}

void Mutator::DamageNumbers(Datagram &datagram, const Part &part)
{
    const std::size_t body = part.Begin + SubmessageHeaderSize;
    const bool sample = datagram[part.Begin] == Data || datagram[part.Begin] == DataFrag;
    // The entity ids come first, in samples after 4 bytes. The numbers follow.
    const std::size_t entities = body + (sample ? 4 : 0);
    const std::size_t numbers = entities + 8;
    if (numbers + 8 > part.End)
    {
        return;
    }
    const std::size_t word = numbers + 4 * Below(std::min<std::size_t>(6, (part.End - numbers) / 4));
    switch (Below(5))
    {
        case 0:
            Put(datagram, entities + 4 * Below(2), 4, false,
                OneIn(2) ? Entities[Below(Entities.size())] : static_cast<std::uint32_t>(_random()));
            break;
        case 1:
            Put(datagram, word, 4, part.LittleEndian, Number());
            break;
        default:
        {
            // The value plus or minus a power of two.
            std::uint32_t value = 0;
            for (std::size_t i = 0; i < 4; ++i)
            {
                value |= std::uint32_t{datagram[word + i]} << (8 * (part.LittleEndian ? i : 3 - i));
            }
            const auto step = static_cast<std::uint32_t>(1u << Below(24));
            Put(datagram, word, 4, part.LittleEndian, OneIn(4) ? value - step : value + step);
            break;
        }
    }
}

void Mutator::DamageParameters(Datagram &datagram, const Part &part)
{
    constexpr std::size_t ToPayload = SubmessageHeaderSize + 20;
    if (datagram[part.Begin] != Data || part.Begin + ToPayload + 8 > part.End)
    {
        return;
    }
    const bool littleEndian = datagram[part.Begin + ToPayload + 1] == 3;
    std::vector<std::size_t> begins;
    for (std::size_t at = part.Begin + ToPayload + 4; at + 4 <= part.End;)
    {
        begins.push_back(at);
        const std::size_t low = datagram[at + (littleEndian ? 2 : 3)];
        const std::size_t high = datagram[at + (littleEndian ? 3 : 2)];
        at += 4 + (low | high << 8);
    }
    const std::size_t at = begins[Below(begins.size())];
    switch (Below(5))
    {
        case 0:
            Put(datagram, at, 2, littleEndian, Parameters[Below(Parameters.size())]);
            break;
        case 1:
            Put(datagram, at + 2, 2, littleEndian, OneIn(2) ? 4 * Below(64) : Number());
            break;
        case 2:
            // The count of a list, or the size of a string.
            Put(datagram, at + 4, 4, littleEndian, Number());
            break;
        case 3:
            Put(datagram, at + 4 + 4 * Below(6), 4, littleEndian, Number());
            break;
        default:
            // The encapsulation header.
            datagram[part.Begin + ToPayload + Below(4)] = static_cast<std::uint8_t>(Below(12));
            break;
    }
}

void Mutator::DamageIdentity(Datagram &datagram)
{
    Datagram prefix(PrefixSize);
    if (OneIn(2))
    {
        prefix = _prefixes[Below(_prefixes.size())];
    }
    else
    {
        std::copy_n(datagram.begin() + PrefixOffset, PrefixSize, prefix.begin());
        prefix[Below(PrefixSize)] = static_cast<std::uint8_t>(OneIn(4) ? 0 : _random());
    }
    const Datagram old(datagram.begin() + PrefixOffset, datagram.begin() + HeaderSize);
    // The prefix changes in the header alone, inside alone, or everywhere. Everywhere is rare: it makes a
    // consistent stranger, a new participant for the nodes.
    const std::size_t where = OneIn(50) ? 2 : Below(2);
    for (auto at = datagram.begin();;)
    {
        at = std::search(at, datagram.end(), old.begin(), old.end());
        if (at == datagram.end())
        {
            return;
        }
        const bool header = at - datagram.begin() == PrefixOffset;
        if (where == 2 || (where == 0) == header)
        {
            std::copy(prefix.begin(), prefix.end(), at);
        }
        at += PrefixSize;
    }
}

void Mutator::SpeakForAnother(Datagram &datagram)
{
    constexpr std::uint8_t InfoSource = 0x0c;
    Datagram source = {InfoSource, 1, 20, 0, 0, 0, 0, 0};
    source.insert(source.end(), datagram.begin() + 4, datagram.begin() + PrefixOffset);
    const Datagram &prefix = _prefixes[Below(_prefixes.size())];
    source.insert(source.end(), prefix.begin(), prefix.end());
    const auto parts = PartsOf(datagram);
    const std::size_t at = parts.empty() ? datagram.size() : parts[Below(parts.size())].Begin;
    datagram.insert(datagram.begin() + static_cast<std::ptrdiff_t>(at), source.begin(), source.end());
}

void Mutator::DamageSize(Datagram &datagram)
{
    if (OneIn(2))
    {
        datagram.resize(datagram.size() - Below(datagram.size() - HeaderSize));
        return;
    }
    for (std::size_t more = 1 + Below(64); more > 0; --more)
    {
        datagram.push_back(static_cast<std::uint8_t>(OneIn(2) ? 0 : _random()));
    }
}

void Mutator::Splice(Datagram &datagram)
{
    const Datagram &other = _originals[Below(_originals.size())];
    const auto parts = PartsOf(other);
    if (parts.empty())
    {
        return;
    }
    const Part part = parts[Below(parts.size())];
    const auto own = PartsOf(datagram);
    const std::size_t at = own.empty() || OneIn(4) ? datagram.size() : own[Below(own.size())].Begin;
    datagram.insert(datagram.begin() + static_cast<std::ptrdiff_t>(at),
                    other.begin() + static_cast<std::ptrdiff_t>(part.Begin),
                    other.begin() + static_cast<std::ptrdiff_t>(part.End));
}
