#pragma once

#include <cstddef>

namespace Rabit::Idl
{

// Adds up the bytes that CdrWriter would write.
class CdrSizer
{
public:
    std::size_t Used() const { return _used; }
    // Adds count primitive values of size bytes each, side by side.
    void Add(std::size_t size, std::size_t count = 1)
    {
        if (count != 0)
        {
            _used = (_used + size - 1) / size * size + size * count;
        }
    }
    // Adds a string of `length` bytes, not counting its terminating zero.
    void AddString(std::size_t length)
    {
        Add(4);
        _used += length + 1;
    }

private:
    std::size_t _used = 0;
};

}  // namespace Rabit::Idl
