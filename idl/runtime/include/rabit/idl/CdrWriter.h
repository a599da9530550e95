#pragma once

#include <rabit/idl/FastCdr.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>

namespace Rabit::Idl
{

// Writes the body of a sample (what follows the encapsulation header) as plain XCDR1, OMG
// DDS-XTypes 1.3, 7.4.1, little endian, into a borrowed buffer. Alignment is relative to the begin of the
// buffer. Unlike Fast-CDR, which does the encoding, it writes zeros where alignment leaves gaps, so that
// equal values give equal bytes. It returns false where Fast-CDR throws. After a false the contents of the
// buffer are unspecified. Used by one thread at a time.
class CdrWriter
{
public:
    explicit CdrWriter(std::span<std::uint8_t> buffer)
        : _size(buffer.size()),
          _buffer(reinterpret_cast<char *>(buffer.data()), buffer.size()),
          _cdr(_buffer, FastCdr::LITTLE_ENDIANNESS)
    {
    }
    CdrWriter(const CdrWriter &) = delete;
    CdrWriter &operator=(const CdrWriter &) = delete;

    // Bytes written so far.
    std::size_t Used() const { return _cdr.Used(); }

    // Writes one primitive value, aligned to its size.
    template <class T>
    bool Put(T value)
    {
        if (!Reserve(sizeof(T), sizeof(T)))
        {
            return false;
        }
        _cdr.serialize(value);
        return true;
    }
    // Writes count primitive values that lie side by side.
    template <class T>
    bool PutArray(const T *values, std::size_t count)
    {
        if (count == 0)
        {
            return true;
        }
        if (count > _size / sizeof(T) || !Reserve(sizeof(T), count * sizeof(T)))
        {
            return false;
        }
        _cdr.PutArray(values, count);
        return true;
    }
    // Writes the length of a sequence or string.
    bool PutLength(std::size_t length)
    {
        return length <= std::numeric_limits<std::uint32_t>::max() && Put(static_cast<std::uint32_t>(length));
    }
    // Writes a string: its length with the terminating zero, its bytes, the zero. False if it contains a
    // zero, which CDR cannot express, or is longer than bound (0: no bound).
    bool PutString(const std::string &text, std::size_t bound)
    {
        if ((bound != 0 && text.size() > bound) || std::memchr(text.data(), 0, text.size()) != nullptr)
        {
            return false;
        }
        return PutLength(text.size() + 1) && PutArray(text.c_str(), text.size() + 1);
    }
    // Fills with zeros up to a multiple of 4 bytes; returns how many. The buffer must have room.
    std::size_t PadToWord()
    {
        const std::size_t before = Used();
        Reserve(4, 0);
        return Used() - before;
    }

private:
    // Checks that size bytes fit after aligning, and writes zeros into the alignment gap.
    bool Reserve(std::size_t alignment, std::size_t size)
    {
        static constexpr std::uint8_t zeros[8] = {};
        const std::size_t used = Used();
        const std::size_t gap = (alignment - used % alignment) % alignment;
        if (_size - used < gap + size)
        {
            return false;
        }
        if (gap != 0)
        {
            _cdr.PutArray(zeros, gap);
        }
        return true;
    }

    std::size_t _size;
    eprosima::fastcdr::FastBuffer _buffer;
    FastCdr _cdr;
};

}  // namespace Rabit::Idl
