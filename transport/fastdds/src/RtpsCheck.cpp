#include "RtpsCheck.h"

#include <cstring>

#include "PayloadPool.h"

namespace Rabit::FastDds
{

namespace
{

constexpr std::size_t HeaderSize = 20;
constexpr std::size_t SubmessageHeaderSize = 4;

// RTPS 2.3, 9.4.5.1.1
enum class Kind : std::uint8_t
{
    Pad = 0x01,
    AckNack = 0x06,
    Heartbeat = 0x07,
    Gap = 0x08,
    InfoTimestamp = 0x09,
    InfoSource = 0x0c,
    InfoDestination = 0x0e,
    NackFrag = 0x12,
    HeartbeatFrag = 0x13,
    Data = 0x15,
    DataFrag = 0x16,
    Statistics = 0x80  // Fast DDS's own, at the end of each of its messages
};

// The vendor asserts both this size and that the submessage is the last one.
constexpr std::size_t StatisticsSize = 56;

// Reads the body of one submessage; everything fails once something did.
class Body
{
public:
    Body(std::span<const std::uint8_t> bytes, bool littleEndian) : _rest(bytes), _littleEndian(littleEndian)
    {
    }

    bool IsGood() const { return _good; }
    std::size_t Left() const { return _rest.size(); }

    void Skip(std::size_t count)
    {
        _good = _good && count <= _rest.size();
        _rest = _good ? _rest.subspan(count) : std::span<const std::uint8_t>();
    }
    std::uint16_t U16() { return static_cast<std::uint16_t>(Number(2)); }
    std::uint32_t U32() { return static_cast<std::uint32_t>(Number(4)); }
    // A sequence number: a signed high word, then a low one.
    std::int64_t Sequence()
    {
        const auto high = static_cast<std::int32_t>(U32());
        return static_cast<std::int64_t>(high) * (std::int64_t{1} << 32) + U32();
    }
    // A set of at most 256 numbers from a base on (9.4.2.6, 9.4.2.8); its bits are skipped.
    void Bitmap()
    {
        const std::uint32_t bits = U32();
        _good = _good && bits <= 256;
        Skip(_good ? 4 * ((bits + 31) / 32) : 0);
    }
    // Parameters up to the sentinel (9.4.2.11).
    void ParameterList()
    {
        constexpr std::uint16_t Sentinel = 1;
        while (_good)
        {
            const std::uint16_t id = U16();
            const std::uint16_t length = U16();
            if (id == Sentinel)
            {
                return;
            }
            _good = _good && length % 4 == 0;
            Skip(length);
        }
    }

private:
    std::uint64_t Number(std::size_t size)
    {
        _good = _good && size <= _rest.size();
        if (!_good)
        {
            return 0;
        }
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size; ++i)
        {
            const std::size_t shift = 8 * (_littleEndian ? i : size - 1 - i);
            value |= std::uint64_t{_rest[i]} << shift;
        }
        _rest = _rest.subspan(size);
        return value;
    }

    std::span<const std::uint8_t> _rest;
    bool _littleEndian;
    bool _good = true;
};

constexpr std::int64_t LargestSequence = std::int64_t{1} << 62;

bool IsSequence(std::int64_t number)
{
    return number >= 1 && number < LargestSequence;
}

// From after the reader and writer ids on: where the inline QoS begins is told relative to the field that
// says so.
bool IsSoundData(Body body, std::uint8_t flags, bool fragmented)
{
    constexpr std::uint8_t InlineQos = 0x02;
    body.Skip(2);  // extra flags
    const std::uint16_t toInlineQos = body.U16();
    const std::size_t before = body.Left();
    body.Skip(8);  // reader and writer
    if (!IsSequence(body.Sequence()))
    {
        return false;
    }
    if (fragmented)
    {
        const std::uint32_t first = body.U32();
        const std::uint16_t count = body.U16();
        const std::uint16_t size = body.U16();
        const std::uint32_t whole = body.U32();
        if (first == 0 || count == 0 || size == 0 || whole == 0 || whole > MaxSample ||
            std::uint64_t{first} + count - 1 > (std::uint64_t{whole} + size - 1) / size)
        {
            return false;
        }
    }
    const std::size_t used = before - body.Left();
    if (!body.IsGood() || toInlineQos < used)
    {
        return false;
    }
    body.Skip(toInlineQos - used);
    if ((flags & InlineQos) != 0)
    {
        body.ParameterList();
    }
    return body.IsGood();
}

bool IsSoundAckNack(Body body)
{
    body.Skip(8);
    const std::int64_t base = body.Sequence();
    body.Bitmap();
    body.U32();  // count
    return body.IsGood() && base >= 0 && base < LargestSequence;
}

bool IsSoundHeartbeat(Body body)
{
    body.Skip(8);
    const std::int64_t first = body.Sequence();
    const std::int64_t last = body.Sequence();
    body.U32();  // count
    return body.IsGood() && IsSequence(first) && last >= first - 1 && last < LargestSequence;
}

bool IsSoundGap(Body body)
{
    body.Skip(8);
    const std::int64_t start = body.Sequence();
    const std::int64_t base = body.Sequence();
    body.Bitmap();
    return body.IsGood() && IsSequence(start) && base >= start && base < LargestSequence;
}

bool IsSoundNackFrag(Body body)
{
    body.Skip(8);
    const std::int64_t sequence = body.Sequence();
    const std::uint32_t base = body.U32();
    body.Bitmap();
    body.U32();  // count
    return body.IsGood() && IsSequence(sequence) && base >= 1;
}

bool IsSoundHeartbeatFrag(Body body)
{
    body.Skip(8);
    const std::int64_t sequence = body.Sequence();
    body.U32();  // last fragment
    body.U32();  // count
    return body.IsGood() && IsSequence(sequence);
}

bool HasSize(Body body, std::size_t size)
{
    body.Skip(size);
    return body.IsGood();
}

bool IsSoundSubmessage(Kind kind, std::uint8_t flags, Body body)
{
    constexpr std::uint8_t Invalidate = 0x02;
    switch (kind)
    {
        case Kind::Data:
            return IsSoundData(body, flags, false);
        case Kind::DataFrag:
            return IsSoundData(body, flags, true);
        case Kind::AckNack:
            return IsSoundAckNack(body);
        case Kind::Heartbeat:
            return IsSoundHeartbeat(body);
        case Kind::Gap:
            return IsSoundGap(body);
        case Kind::NackFrag:
            return IsSoundNackFrag(body);
        case Kind::HeartbeatFrag:
            return IsSoundHeartbeatFrag(body);
        case Kind::InfoTimestamp:
            return (flags & Invalidate) != 0 || HasSize(body, 8);
        case Kind::InfoSource:
            return HasSize(body, 20);
        case Kind::InfoDestination:
            return HasSize(body, 12);
        case Kind::Pad:
        case Kind::Statistics:
            return true;
    }
    return true;
}

}  // namespace

bool IsSoundRtps(std::span<const std::uint8_t> datagram)
{
    constexpr std::uint8_t LittleEndian = 0x01;
    if (datagram.size() < HeaderSize || std::memcmp(datagram.data(), "RTPS", 4) != 0 || datagram[4] != 2)
    {
        return false;
    }
    auto rest = datagram.subspan(HeaderSize);
    while (!rest.empty())
    {
        if (rest.size() < SubmessageHeaderSize)
        {
            return false;
        }
        const auto kind = static_cast<Kind>(rest[0]);
        const std::uint8_t flags = rest[1];
        const bool littleEndian = (flags & LittleEndian) != 0;
        std::size_t length = Body(rest.subspan(2, 2), littleEndian).U16();
        rest = rest.subspan(SubmessageHeaderSize);
        if (length == 0 && kind != Kind::Pad && kind != Kind::InfoTimestamp)
        {
            length = rest.size();  // 9.4.5.1.3: it extends to the end of the message
        }
        if (kind == Kind::Statistics && (length != StatisticsSize || rest.size() != length))
        {
            return false;
        }
        if (length > rest.size() || !IsSoundSubmessage(kind, flags, Body(rest.first(length), littleEndian)))
        {
            return false;
        }
        rest = rest.subspan(length);
    }
    return true;
}

}  // namespace Rabit::FastDds
