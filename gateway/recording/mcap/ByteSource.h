#pragma once

#include <cstdint>
#include <span>

namespace Rabit::Mcap
{

// Gives the bytes of a file.
class ByteSource
{
public:
    virtual ~ByteSource() = default;
    virtual std::uint64_t Size() = 0;
    // Fills all of `to` with the bytes from that offset on; false if they cannot be read.
    virtual bool Read(std::uint64_t offset, std::span<std::uint8_t> to) = 0;
};

}  // namespace Rabit::Mcap
