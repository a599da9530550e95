// Reads numbers off the front of untrusted bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// Never reads out of bounds: once bytes are missing, all further values are 0 and IsGood() is false.
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
    EntityId Entity() { return static_cast<EntityId>(Number(4, false)); }
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

}  // namespace Rabit::Rtps
