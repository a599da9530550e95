#pragma once

#include <cstdint>
#include <span>

namespace Rabit::Mcap
{

// Gives the bytes of a file. FileSource is one; a program may implement others. A reader calls it on its own
// thread alone. The bytes need not be trusted: no content makes the readers of this folder throw.
class ByteSource
{
public:
    virtual ~ByteSource() = default;
    // Returns the number of bytes, which must not become less.
    virtual std::uint64_t Size() = 0;
    // Fills all of `to` with the bytes from that offset on; false if they cannot be read.
    virtual bool Read(std::uint64_t offset, std::span<std::uint8_t> to) = 0;
};

}  // namespace Rabit::Mcap
