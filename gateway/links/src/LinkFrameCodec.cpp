#include <rabit/gateway/links/LinkFrameCodec.h>

#include "OutcomeRuns.h"

#include <rabit/base/WireBytes.h>

#include <algorithm>

namespace Rabit::LinkFrameCodec
{

namespace
{

constexpr std::int64_t Microsecond = 1000;
constexpr std::uint64_t MostMicroseconds = (std::uint64_t{1} << 62) / 1000;

// Flags of a frame.
constexpr std::uint8_t IsShort = 1;
constexpr std::uint8_t Asks = 2;
constexpr std::uint8_t CarriesData = 4;
constexpr std::uint8_t CarriesAcks = 8;
constexpr std::uint8_t CarriesEcho = 16;
constexpr std::uint8_t FrameFlags = 31;
// Flags of an item, beside the LinkFlags.
constexpr std::uint8_t LinkFlags = LinkFlagSkip | LinkFlagRedelivered | LinkFlagFirst | LinkFlagLast;
constexpr std::uint8_t HasTtl = 16;
constexpr std::uint8_t HasTypeName = 32;
constexpr std::uint8_t HasGap = 64;
// Flags of an acknowledgement, in the low bits of its first number.
constexpr std::uint64_t IsOpen = 1;

std::uint64_t Micro(std::int64_t nanoseconds)
{
    return static_cast<std::uint64_t>(nanoseconds / Microsecond);
}
std::int64_t Nano(std::uint64_t microseconds)
{
    return static_cast<std::int64_t>(microseconds) * Microsecond;
}
std::uint32_t LowMicro(std::int64_t nanoseconds)
{
    return static_cast<std::uint32_t>(Micro(nanoseconds));
}

std::uint8_t FlagsOf(const LinkFrame &frame)
{
    return static_cast<std::uint8_t>(
        (frame.Short ? IsShort : 0) | (frame.Ask ? Asks : 0) | (frame.HasData ? CarriesData : 0) |
        (frame.Acks.empty() ? 0 : CarriesAcks) | (!frame.Short && frame.Echo.Clock != 0 ? CarriesEcho : 0));
}

bool IsWholeSkip(const LinkItem &item)
{
    return (item.Flags & LinkFlagSkip) != 0;
}
bool CarriesSize(const LinkItem &item)
{
    return (item.Flags & LinkFlagFirst) != 0 && (item.Flags & LinkFlagLast) == 0;
}

// Bytes of an item before its payload, without the gap.
std::size_t ItemHead(const LinkItem &item)
{
    if (IsWholeSkip(item))
    {
        return 1 + VarintSize(item.Through - item.Sequence);
    }
    std::size_t size = 1 + VarintSize(item.Payload.size());
    if ((item.Flags & LinkFlagLast) != 0 && item.TtlLeft != LinkNoExpiry)
    {
        size += VarintSize(Micro(item.TtlLeft));
    }
    if ((item.Flags & LinkFlagFirst) != 0)
    {
        size += VarintSize(item.TypeNumber) + (item.Type.empty() ? 0 : 1 + item.Type.size());
    }
    return size + (CarriesSize(item) ? VarintSize(item.Size) : 0);
}

std::size_t HeldBytes(const LinkAck &ack)
{
    std::size_t words = ack.Held.size();
    while (words > 0 && ack.Held[words - 1] == 0)
    {
        --words;
    }
    std::size_t bytes = words * 8;
    while (bytes > 0 && ((ack.Held[(bytes - 1) / 8] >> (8 * ((bytes - 1) % 8))) & 0xff) == 0)
    {
        --bytes;
    }
    return bytes;
}

void Put(WireWriter &writer, const LinkAck &ack)
{
    writer.Varint((std::uint64_t{ack.Link} << 1) | (ack.Open ? IsOpen : 0));
    if (!ack.Open)
    {
        return;
    }
    writer.Varint(ack.Cumulative);
    writer.Varint(ack.Cumulative + 1 - ack.Oldest);
    OutcomeRuns::Visit(ack, [&writer](std::uint64_t run) { writer.Varint(run); });
    writer.Varint(ack.Credit);
    const std::size_t held = HeldBytes(ack);
    writer.Varint(held);
    for (std::size_t i = 0; i < held; ++i)
    {
        writer.Byte(static_cast<std::uint8_t>(ack.Held[i / 8] >> (8 * (i % 8))));
    }
}

void Get(WireReader &reader, LinkAck &ack)
{
    ack = {};
    const std::uint64_t first = reader.Varint(std::uint64_t{0xffffffff} * 2 + 1);
    ack.Link = static_cast<std::uint32_t>(first >> 1);
    ack.Open = (first & IsOpen) != 0;
    if (!ack.Open)
    {
        return;
    }
    ack.Cumulative = reader.Varint();
    const std::uint64_t told = reader.Varint(std::min<std::uint64_t>(ack.Cumulative, LinkWindowParts));
    ack.Oldest = ack.Cumulative + 1 - told;
    for (std::uint64_t sequence = ack.Oldest; reader.IsGood() && sequence <= ack.Cumulative;)
    {
        const std::uint64_t run = reader.Varint(OutcomeRuns::Largest(ack.Cumulative + 1 - sequence));
        if (!reader.IsGood() || !OutcomeRuns::Take(run, sequence, ack))
        {
            reader.Fail();
        }
    }
    ack.Credit = static_cast<std::uint32_t>(reader.Varint(0xffffffff));
    const std::size_t held = static_cast<std::size_t>(reader.Varint(LinkWindowParts / 8));
    const std::span<const std::uint8_t> bytes = reader.Bytes(held);
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        ack.Held[i / 8] |= std::uint64_t{bytes[i]} << (8 * (i % 8));
    }
}

void Put(WireWriter &writer, const LinkItem &item, bool gap, std::uint64_t skipped)
{
    const bool last = (item.Flags & LinkFlagLast) != 0 && !IsWholeSkip(item);
    const bool first = (item.Flags & LinkFlagFirst) != 0 && !IsWholeSkip(item);
    const bool ttl = last && item.TtlLeft != LinkNoExpiry;
    const bool named = first && !item.Type.empty();
    writer.Byte(static_cast<std::uint8_t>(item.Flags | (ttl ? HasTtl : 0) | (named ? HasTypeName : 0) |
                                          (gap ? HasGap : 0)));
    if (gap)
    {
        writer.Varint(skipped);
    }
    if (IsWholeSkip(item))
    {
        writer.Varint(item.Through - item.Sequence);
        return;
    }
    if (ttl)
    {
        writer.Varint(Micro(item.TtlLeft));
    }
    if (first)
    {
        writer.Varint(item.TypeNumber);
        if (named)
        {
            writer.Name(item.Type);
        }
    }
    if (CarriesSize(item))
    {
        writer.Varint(item.Size);
    }
    writer.Varint(item.Payload.size());
    writer.Bytes(item.Payload.data(), item.Payload.size());
}

// `next`: the number of the item if there is no gap; on return the number after the item.
void Get(WireReader &reader, LinkItem &item, std::uint64_t &next)
{
    const std::uint8_t flags = reader.Byte();
    item = {};
    item.Flags = flags & LinkFlags;
    item.Sequence = next + ((flags & HasGap) != 0 ? reader.Varint(~next) : 0);
    item.Through = item.Sequence;
    if (IsWholeSkip(item))
    {
        item.Through += reader.Varint(~item.Sequence);
    }
    else
    {
        if ((flags & HasTtl) != 0)
        {
            item.TtlLeft = Nano(reader.Varint(MostMicroseconds));
        }
        if ((item.Flags & LinkFlagFirst) != 0)
        {
            item.TypeNumber = static_cast<std::uint32_t>(reader.Varint(LinkMaxTypes));
            item.Type = (flags & HasTypeName) != 0 ? reader.Name() : std::string_view();
        }
        item.Size = CarriesSize(item) ? reader.Varint() : 0;
        item.Payload = reader.Bytes(static_cast<std::size_t>(reader.Varint(reader.Left())));
    }
    next = item.Through + 1;
    if ((flags & 0x80) != 0 || next == 0)
    {
        reader.Fail();
    }
}

void Put(WireWriter &writer, const LinkData &data)
{
    writer.Varint((std::uint64_t{data.Link} << 1) | (data.Queue.empty() ? 0 : 1));
    if (!data.Queue.empty())
    {
        writer.Name(data.Queue);
    }
    writer.Varint(data.Oldest);
    writer.Varint(data.Items.size());
    std::uint64_t next = data.Oldest;
    for (const LinkItem &item : data.Items)
    {
        Put(writer, item, item.Sequence != next, item.Sequence - next);
        next = item.Through + 1;
    }
}

void Get(WireReader &reader, LinkData &data)
{
    const std::uint64_t first = reader.Varint(std::uint64_t{0xffffffff} * 2 + 1);
    data.Link = static_cast<std::uint32_t>(first >> 1);
    data.Queue = (first & 1) != 0 ? reader.Name() : std::string_view();
    data.Oldest = reader.Varint();
    // An item has two bytes at least.
    data.Items.resize(static_cast<std::size_t>(reader.Varint(std::min(LinkMaxItems, reader.Left() / 2))));
    std::uint64_t next = data.Oldest;
    for (LinkItem &item : data.Items)
    {
        Get(reader, item, next);
    }
}

}  // namespace

std::size_t HeaderSize(const LinkFrame &frame)
{
    if (frame.Short)
    {
        return 2 + 3 * 4 + VarintSize(Micro(frame.Echo.HeldFor));
    }
    const std::size_t echo = frame.Echo.Clock == 0 ? 0
                                                   : 4 + VarintSize(Micro(frame.Echo.Time)) +
                                                         VarintSize(Micro(frame.Echo.HeldFor));
    return 2 + 4 + 8 + 8 + 4 + VarintSize(Micro(frame.Time)) + echo;
}

std::size_t DataSize(const LinkData &data)
{
    return VarintSize(std::uint64_t{data.Link} << 1) + (data.Queue.empty() ? 0 : 1 + data.Queue.size()) +
           VarintSize(data.Oldest) + 2;
}

std::size_t ItemSize(const LinkItem &item)
{
    // The gap is below LinkWindowParts.
    return ItemHead(item) + 2;
}

std::size_t AckSize(const LinkAck &ack)
{
    std::size_t size = VarintSize(std::uint64_t{ack.Link} << 1);
    if (ack.Open)
    {
        const std::size_t held = HeldBytes(ack);
        size += VarintSize(ack.Cumulative) + VarintSize(ack.Cumulative + 1 - ack.Oldest) +
                VarintSize(ack.Credit) + VarintSize(held) + held;
        OutcomeRuns::Visit(ack, [&size](std::uint64_t run) { size += VarintSize(run); });
    }
    return size;
}

std::size_t EncodedSize(const LinkFrame &frame)
{
    std::size_t size = HeaderSize(frame);
    if (!frame.Acks.empty())
    {
        ++size;
        for (const LinkAck &ack : frame.Acks)
        {
            size += AckSize(ack);
        }
    }
    if (frame.HasData)
    {
        const LinkData &data = frame.Data;
        size += DataSize(data) - 2 + VarintSize(data.Items.size());
        std::uint64_t next = data.Oldest;
        for (const LinkItem &item : data.Items)
        {
            size += ItemHead(item) + item.Payload.size() +
                    (item.Sequence != next ? VarintSize(item.Sequence - next) : 0);
            next = item.Through + 1;
        }
    }
    return size;
}

void Encode(const LinkFrame &frame, std::span<std::uint8_t> bytes)
{
    WireWriter writer(bytes);
    writer.Byte(frame.Version);
    writer.Byte(FlagsOf(frame));
    writer.Fixed(frame.Check);
    if (frame.Short)
    {
        writer.Fixed(LowMicro(frame.Time));
        writer.Fixed(LowMicro(frame.Echo.Time));
        writer.Varint(Micro(frame.Echo.HeldFor));
    }
    else
    {
        writer.Fixed(frame.SenderLife);
        writer.Fixed(frame.ReceiverLife);
        writer.Fixed(frame.Clock);
        writer.Varint(Micro(frame.Time));
        if (frame.Echo.Clock != 0)
        {
            writer.Fixed(frame.Echo.Clock);
            writer.Varint(Micro(frame.Echo.Time));
            writer.Varint(Micro(frame.Echo.HeldFor));
        }
    }
    if (!frame.Acks.empty())
    {
        writer.Byte(static_cast<std::uint8_t>(frame.Acks.size()));
        for (const LinkAck &ack : frame.Acks)
        {
            Put(writer, ack);
        }
    }
    if (frame.HasData)
    {
        Put(writer, frame.Data);
    }
}

bool Decode(std::span<const std::uint8_t> bytes, LinkFrame &frame)
{
    WireReader reader(bytes);
    frame.Version = reader.Byte();
    const std::uint8_t flags = reader.Byte();
    if (frame.Version != LinkVersion || (flags & ~FrameFlags) != 0)
    {
        return false;
    }
    frame.Short = (flags & IsShort) != 0;
    frame.Ask = (flags & Asks) != 0;
    frame.HasData = (flags & CarriesData) != 0;
    frame.Check = reader.Fixed<std::uint32_t>();
    frame.SenderLife = frame.ReceiverLife = 0;
    frame.Clock = 0;
    frame.Echo = {};
    if (frame.Short)
    {
        frame.Time = Nano(reader.Fixed<std::uint32_t>());
        frame.Echo.Time = Nano(reader.Fixed<std::uint32_t>());
        frame.Echo.HeldFor = Nano(reader.Varint(MostMicroseconds));
    }
    else
    {
        frame.SenderLife = reader.Fixed<std::uint64_t>();
        frame.ReceiverLife = reader.Fixed<std::uint64_t>();
        frame.Clock = reader.Fixed<std::uint32_t>();
        frame.Time = Nano(reader.Varint(MostMicroseconds));
        if ((flags & CarriesEcho) != 0)
        {
            frame.Echo.Clock = reader.Fixed<std::uint32_t>();
            frame.Echo.Time = Nano(reader.Varint(MostMicroseconds));
            frame.Echo.HeldFor = Nano(reader.Varint(MostMicroseconds));
        }
    }
    frame.Acks.resize((flags & CarriesAcks) != 0 ? std::min<std::size_t>(reader.Byte(), LinkMaxAcks) : 0);
    for (LinkAck &ack : frame.Acks)
    {
        Get(reader, ack);
    }
    frame.Data.Items.clear();
    if (frame.HasData)
    {
        Get(reader, frame.Data);
    }
    return reader.IsAtEnd();
}

}  // namespace Rabit::LinkFrameCodec
