// Writes a sample as little-endian plain XCDR1 into a buffer that grows, with zeros in gaps, by the rules of
// idl/runtime's CdrWriter.
#pragma once

#include <rabit/idl/GeneratedMessageType.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace Rabit::Dynamic
{

static_assert(std::endian::native == std::endian::little, "values are copied as they are in memory");

class CdrBuilder
{
public:
    CdrBuilder() : _bytes(Idl::EncapsulationSize) {}

    void Reserve(std::size_t size) { _bytes.reserve(size); }
    // Bytes written, the encapsulation header included.
    std::size_t Size() const { return _bytes.size(); }
    // Appends a number of `size` bytes, given by its bits.
    void Put(std::uint64_t bits, unsigned size)
    {
        Align(size);
        const std::size_t at = _bytes.size();
        _bytes.resize(at + size);
        std::memcpy(_bytes.data() + at, &bits, size);
    }
    void PutBytes(std::span<const std::uint8_t> bytes)
    {
        _bytes.insert(_bytes.end(), bytes.begin(), bytes.end());
    }
    void PutString(std::string_view text)
    {
        Put(text.size() + 1, 4);
        _bytes.insert(_bytes.end(), text.begin(), text.end());
        _bytes.push_back(0);
    }
    // Overwrites a 4-byte number at `at`: the value of Size() before it was put. Size() was a multiple of 4
    // then.
    void Replace(std::size_t at, std::uint32_t number) { std::memcpy(_bytes.data() + at, &number, 4); }
    void Align(unsigned size)
    {
        const std::size_t body = _bytes.size() - Idl::EncapsulationSize;
        _bytes.resize(_bytes.size() + (size - body % size) % size);
    }
    // The whole sample, padded.
    std::vector<std::uint8_t> Finish()
    {
        const std::size_t before = _bytes.size();
        Align(4);
        Idl::WriteEncapsulation(_bytes, _bytes.size() - before);
        return std::move(_bytes);
    }

private:
    std::vector<std::uint8_t> _bytes;
};

}  // namespace Rabit::Dynamic
