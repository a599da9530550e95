// Reads RTPS messages as untrusted input (OMG DDSI-RTPS 2.3, 9.4).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/Rtps.h"

namespace Rabit::Rtps
{

// Reads numbers off the front of bytes. Never reads out of bounds: once bytes are missing, all further values
// are 0 and IsGood() is false.
class RtpsReader
{
public:
    RtpsReader(std::span<const std::uint8_t> bytes, bool littleEndian)
        : _all(bytes), _rest(bytes), _littleEndian(littleEndian)
    {
    }

    bool IsGood() const { return _good; }
    std::size_t Left() const { return _rest.size(); }
    std::size_t Position() const { return _all.size() - _rest.size(); }
    std::span<const std::uint8_t> Rest() const { return _rest; }

    std::span<const std::uint8_t> Bytes(std::size_t count)
    {
        _good = _good && count <= _rest.size();
        const auto taken = _good ? _rest.first(count) : std::span<const std::uint8_t>();
        _rest = _good ? _rest.subspan(count) : std::span<const std::uint8_t>();
        return taken;
    }
    void Skip(std::size_t count) { Bytes(count); }

    std::uint16_t U16() { return static_cast<std::uint16_t>(Number(2, _littleEndian)); }
    std::uint32_t U32() { return static_cast<std::uint32_t>(Number(4, _littleEndian)); }
    std::uint64_t U64() { return Number(8, _littleEndian); }
    EntityId Entity() { return static_cast<EntityId>(Number(4, false)); }
    // Zero if bytes are missing.
    GuidPrefix Prefix()
    {
        GuidPrefix prefix{};
        const auto bytes = Bytes(prefix.size());
        std::copy(bytes.begin(), bytes.end(), prefix.begin());
        return prefix;
    }
    // A sequence number: a signed high word, then a low one. -1 if it is negative, or too large for
    // arithmetic.
    std::int64_t Sequence()
    {
        constexpr std::uint32_t TooHigh = 1u << 30;
        const std::uint32_t high = U32();
        const std::uint32_t low = U32();
        return high < TooHigh ? static_cast<std::int64_t>(std::uint64_t{high} << 32 | low) : -1;
    }
    // Skips the bits of a set of at most 256 numbers (9.4.2.6, 9.4.2.8); returns how many they are.
    std::uint32_t Bits()
    {
        const std::uint32_t bits = U32();
        _good = _good && bits <= 256;
        Skip(_good ? 4 * ((bits + 31) / 32) : 0);
        return _good ? bits : 0;
    }

private:
    std::uint64_t Number(std::size_t size, bool littleEndian)
    {
        const auto bytes = Bytes(size);
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < bytes.size(); ++i)
        {
            const std::size_t shift = 8 * (littleEndian ? i : bytes.size() - 1 - i);
            value |= std::uint64_t{bytes[i]} << shift;
        }
        return value;
    }

    std::span<const std::uint8_t> _all;
    std::span<const std::uint8_t> _rest;
    bool _littleEndian;
    bool _good = true;
};

// Byte: const std::uint8_t, or std::uint8_t to change it.
template <typename Byte>
struct SubmessageOf
{
    SubmessageKind Kind = SubmessageKind::Pad;
    std::uint8_t Flags = 0;
    bool LittleEndian = false;
    std::span<Byte> Whole;  // includes the header
    std::span<Byte> Body() const { return Whole.subspan(SubmessageHeaderSize); }
    RtpsReader Reader() const { return RtpsReader(Body(), LittleEndian); }
};
using Submessage = SubmessageOf<std::uint8_t>;
using ConstSubmessage = SubmessageOf<const std::uint8_t>;

// Calls visit(submessage) for each submessage behind the header of a message. The message may be cut off and
// its content may be invalid: the last submessage then ends with the message, and nothing outside of it is
// touched.
template <typename Byte, typename Visit>
void VisitSubmessages(std::span<Byte> message, const Visit &visit)
{
    auto rest = message.subspan(std::min(RtpsHeaderSize, message.size()));
    while (rest.size() >= SubmessageHeaderSize)
    {
        SubmessageOf<Byte> found{SubmessageKind{rest[0]}, rest[1], (rest[1] & LittleEndianFlag) != 0, rest};
        const std::size_t length = RtpsReader(rest.subspan(2), found.LittleEndian).U16();
        // 9.4.5.1.3: for all other kinds, a length of 0 means up to the end of the message.
        if (length > 0 || found.Kind == SubmessageKind::Pad || found.Kind == SubmessageKind::InfoTimestamp)
        {
            found.Whole = rest.first(std::min(SubmessageHeaderSize + length, rest.size()));
        }
        visit(found);
        rest = rest.subspan(found.Whole.size());
    }
}

// The writer that a submessage of a writer or a reader (IsDelivery) names; empty if it is cut off.
inline std::optional<EntityId> WriterOf(const ConstSubmessage &submessage)
{
    const bool isData =
        submessage.Kind == SubmessageKind::Data || submessage.Kind == SubmessageKind::DataFrag;
    RtpsReader body = submessage.Reader();
    body.Skip(isData ? WriterInData : sizeof(EntityId));
    const EntityId writer = body.Entity();
    return body.IsGood() ? std::optional(writer) : std::nullopt;
}

// The prefix with which the bytes begin, such as the body of an INFO_DST; zero if there are too few.
inline GuidPrefix PrefixOf(std::span<const std::uint8_t> bytes)
{
    return RtpsReader(bytes, false).Prefix();
}

struct ListParameter
{
    std::uint16_t Id = 0;
    std::span<const std::uint8_t> Value{};
    std::size_t At = 0;  // offset in the list, where its id and its length begin
};

// Takes the next parameter of a list (9.4.2.11). Empty at the sentinel, which is taken too, and if bytes are
// missing: the list is then no longer good.
inline std::optional<ListParameter> TakeParameter(RtpsReader &list)
{
    ListParameter found{.At = list.Position()};
    found.Id = list.U16();
    const std::uint16_t length = list.U16();
    if (!list.IsGood() || found.Id == Parameters::Sentinel)
    {
        return std::nullopt;
    }
    found.Value = list.Bytes(length);
    return list.IsGood() ? std::optional(found) : std::nullopt;
}

// True if a payload, which must have an encapsulation header (10.2), is a little-endian list of parameters.
inline bool IsLittleEndianList(std::span<const std::uint8_t> payload)
{
    return payload[1] == 3;
}

// Calls visit(parameter) for each parameter of the list in a payload, up to the first unsound one.
template <typename Visit>
void VisitParameters(std::span<const std::uint8_t> payload, const Visit &visit)
{
    if (payload.size() < EncapsulationSize)
    {
        return;
    }
    RtpsReader list(payload.subspan(EncapsulationSize), IsLittleEndianList(payload));
    while (const auto parameter = TakeParameter(list))
    {
        visit(*parameter);
    }
}

}  // namespace Rabit::Rtps
