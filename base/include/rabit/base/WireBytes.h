#pragma once

#include <rabit/base/LittleEndian.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

namespace Rabit
{

// Bytes that WireWriter::Varint writes for the number: 1 to 10, one for each seven bits.
inline std::size_t VarintSize(std::uint64_t value)
{
    std::size_t size = 1;
    for (; value >= 0x80; value >>= 7)
    {
        ++size;
    }
    return size;
}

// Appends a name as WireWriter::Name writes it. At most 255 bytes.
inline void PutName(std::string_view name, std::vector<std::uint8_t> &bytes)
{
    bytes.push_back(static_cast<std::uint8_t>(name.size()));
    bytes.insert(bytes.end(), name.begin(), name.end());
}

// Writes fields one behind the other: numbers of a fixed size little-endian, varints in groups of seven bits
// with the lowest first, names behind a byte with their length. Checks no bounds: the caller computes the
// size first. Not thread-safe.
class WireWriter
{
public:
    explicit WireWriter(std::span<std::uint8_t> bytes) : _at(bytes.data()) {}

    void Byte(std::uint8_t value) { *_at++ = value; }
    void Varint(std::uint64_t value)
    {
        for (; value >= 0x80; value >>= 7)
        {
            Byte(static_cast<std::uint8_t>(value | 0x80));
        }
        Byte(static_cast<std::uint8_t>(value));
    }
    template <typename Number>
    void Fixed(Number value)
    {
        LittleEndian::Write(value, _at);
        _at += sizeof value;
    }
    void Bytes(const void *data, std::size_t size)
    {
        if (size > 0)
        {
            std::memcpy(_at, data, size);
            _at += size;
        }
    }
    // At most 255 bytes.
    void Name(std::string_view name)
    {
        Byte(static_cast<std::uint8_t>(name.size()));
        Bytes(name.data(), name.size());
    }

private:
    std::uint8_t *_at;
};

// Reads the format of WireWriter from untrusted bytes, never beyond the end. After a missing or impossible
// value IsGood is false, and all further values are zero or empty: one look at the end is enough. Spans and
// names refer to the bytes that are read, which must outlive them. Allocates nothing. Not thread-safe.
class WireReader
{
public:
    explicit WireReader(std::span<const std::uint8_t> bytes) : _left(bytes) {}

    bool IsGood() const { return _good; }
    // The caller finds a value impossible.
    void Fail() { _good = false; }
    // Number of bytes that were not read.
    std::size_t Left() const { return _left.size(); }
    // True if all bytes were read, and all values are good.
    bool IsAtEnd() const { return _good && _left.empty(); }

    std::uint8_t Byte()
    {
        const std::span<const std::uint8_t> read = Bytes(1);
        return read.empty() ? std::uint8_t{0} : read[0];
    }
    // A byte that must not be above `most`.
    std::uint8_t Byte(std::size_t most)
    {
        const std::uint8_t value = Byte();
        _good = _good && value <= most;
        return _good ? value : std::uint8_t{0};
    }
    // A value of an enumeration, in a byte that must not be above `last`.
    template <typename Enumeration>
    Enumeration Enumerator(Enumeration last)
    {
        return static_cast<Enumeration>(Byte(static_cast<std::size_t>(last)));
    }
    std::uint64_t Varint()
    {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7)
        {
            const std::uint8_t seven = Byte();
            value |= static_cast<std::uint64_t>(seven & 0x7f) << shift;
            if ((seven & 0x80) == 0)
            {
                // The tenth byte has room for a single bit.
                _good = _good && (shift < 63 || seven <= 1);
                return _good ? value : 0;
            }
        }
        _good = false;
        return 0;
    }
    // A number that must not be above `most`.
    std::uint64_t Varint(std::uint64_t most)
    {
        const std::uint64_t value = Varint();
        _good = _good && value <= most;
        return _good ? value : 0;
    }
    template <typename Number>
    Number Fixed()
    {
        return LittleEndian::Read<Number>(Bytes(sizeof(Number)));
    }
    std::span<const std::uint8_t> Bytes(std::size_t size)
    {
        if (!_good || size > _left.size())
        {
            _good = false;
            return {};
        }
        const std::span<const std::uint8_t> bytes = _left.first(size);
        _left = _left.subspan(size);
        return bytes;
    }
    // A name of at most 255 bytes. It may contain any bytes.
    std::string_view Name()
    {
        const std::span<const std::uint8_t> bytes = Bytes(Byte());
        return {reinterpret_cast<const char *>(bytes.data()), bytes.size()};
    }
    // A name that must have `least` to `most` bytes.
    std::string_view Name(std::size_t least, std::size_t most)
    {
        const std::string_view name = Name();
        _good = _good && name.size() >= least && name.size() <= most;
        return _good ? name : std::string_view();
    }

private:
    std::span<const std::uint8_t> _left;
    bool _good = true;
};

}  // namespace Rabit
