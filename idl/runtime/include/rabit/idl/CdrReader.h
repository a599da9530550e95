#pragma once

#include <rabit/idl/FastCdr.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace Rabit::Idl
{

// Reads the body of a sample (what follows the encapsulation header) as plain XCDR1, OMG DDS-XTypes 1.3,
// 7.4.1, of either byte order, from borrowed bytes. Alignment is relative to the begin of the bytes. Each
// value is checked against the bytes left before it is read, and against a budget before memory is
// allocated for it. If it does not fit, the functions return false; Fast-CDR, which does the decoding,
// never throws. Used by one thread at a time.
class CdrReader
{
public:
    // Decoding may allocate MaxGrowth bytes for each byte of the sample, plus Allowance bytes. Practical
    // types stay far below; a sequence of elements that are small on the wire and large in memory may
    // exceed it.
    static constexpr std::size_t MaxGrowth = 256;
    static constexpr std::size_t Allowance = 65536;

    CdrReader(std::span<const std::uint8_t> bytes, bool littleEndian)
        : _bytes(bytes),
          _budget(MaxGrowth * bytes.size() + Allowance),
          // Fast-CDR takes no constant buffer, but does not write to it when reading.
          _buffer(const_cast<char *>(reinterpret_cast<const char *>(bytes.data())), bytes.size()),
          _cdr(_buffer, littleEndian ? FastCdr::LITTLE_ENDIANNESS : FastCdr::BIG_ENDIANNESS)
    {
    }
    CdrReader(const CdrReader &) = delete;
    CdrReader &operator=(const CdrReader &) = delete;

    std::size_t Used() const { return _cdr.Used(); }
    std::size_t Left() const { return _bytes.size() - Used(); }

    // Subtracts count objects of `size` bytes in memory from the budget; false if the budget is too small.
    bool Spend(std::size_t count, std::size_t size)
    {
        const std::uint64_t wanted = std::uint64_t{count} * size;  // a count has 32 bits
        if (wanted > _budget)
        {
            return false;
        }
        _budget -= wanted;
        return true;
    }

    // Reads one primitive value, aligned to its size.
    template <class T>
    bool Get(T &value)
    {
        if (!Align(sizeof(T), sizeof(T)))
        {
            return false;
        }
        _cdr.deserialize(value);
        return true;
    }
    // Reads a boolean; false if it is neither 0 nor 1.
    bool GetBool(bool &value)
    {
        std::uint8_t byte = 0;
        if (!Get(byte) || byte > 1)
        {
            return false;
        }
        value = byte != 0;
        return true;
    }
    // Reads count primitive values side by side. False if the bytes left are too few.
    template <class T>
    bool GetArray(T *values, std::size_t count)
    {
        if (count == 0)
        {
            return true;
        }
        if (count > Left() / sizeof(T) || !Align(sizeof(T), count * sizeof(T)))
        {
            return false;
        }
        _cdr.GetArray(values, count);
        return true;
    }
    // Reads the length of a sequence; false if it is above bound (0: no bound) or if the bytes left are too
    // few for that many elements of at least minSize bytes.
    bool GetLength(std::size_t bound, std::size_t minSize, std::size_t &length)
    {
        std::uint32_t value = 0;
        if (!Get(value) || (bound != 0 && value > bound) || value > Left() / minSize)
        {
            return false;
        }
        length = value;
        return true;
    }
    // Reads a string as a view of the bytes, without its terminating zero. False if it has none, contains
    // another, or is longer than bound (0: no bound).
    bool GetString(std::size_t bound, std::string_view &text)
    {
        std::size_t length = 0;
        if (!GetLength(0, 1, length) || length == 0 || (bound != 0 && length - 1 > bound))
        {
            return false;
        }
        const char *begin = reinterpret_cast<const char *>(_bytes.data()) + Used();
        if (std::memchr(begin, 0, length) != begin + length - 1)
        {
            return false;
        }
        text = std::string_view(begin, length - 1);
        return _cdr.jump(length);
    }
    // Reads `count` bytes as a view of them.
    bool GetBytes(std::size_t count, std::span<const std::uint8_t> &bytes)
    {
        if (count > Left())
        {
            return false;
        }
        bytes = _bytes.subspan(Used(), count);
        return count == 0 || _cdr.jump(count);
    }
    // Skips count primitive values side by side.
    bool Skip(std::size_t size, std::size_t count)
    {
        if (count == 0)
        {
            return true;
        }
        return count <= Left() / size && Align(size, count * size) && _cdr.jump(count * size);
    }

private:
    // Checks that size bytes are left after aligning, and skips the alignment gap.
    bool Align(std::size_t alignment, std::size_t size)
    {
        const std::size_t gap = (alignment - Used() % alignment) % alignment;
        return Left() >= gap + size && (gap == 0 || _cdr.jump(gap));
    }

    std::span<const std::uint8_t> _bytes;
    std::uint64_t _budget;
    eprosima::fastcdr::FastBuffer _buffer;
    FastCdr _cdr;
};

}  // namespace Rabit::Idl
