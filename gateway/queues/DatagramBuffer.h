#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace Rabit
{

// Memory for one datagram. Unlike a std::vector it is not filled with zeros before it is written.
class DatagramBuffer
{
public:
    // What it held is lost.
    std::span<std::uint8_t> Resize(std::size_t size)
    {
        if (size > _capacity)
        {
            _memory = std::make_unique_for_overwrite<std::uint8_t[]>(size);
            _capacity = size;
        }
        _size = size;
        return {_memory.get(), _size};
    }
    std::span<const std::uint8_t> Bytes() const { return {_memory.get(), _size}; }

private:
    std::unique_ptr<std::uint8_t[]> _memory;
    std::size_t _capacity = 0;
    std::size_t _size = 0;
};

}  // namespace Rabit
