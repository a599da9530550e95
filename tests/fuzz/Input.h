// Takes the bytes of a fuzzer apart.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>
#include <vector>

namespace Fuzz
{

// Parses one input. Each target defines it, and Work.cpp calls it.
int OneInput(const std::uint8_t *data, std::size_t size);

// Ends the process, which the fuzzer reports, unless it is true.
inline void Require(bool holds)
{
    if (!holds)
    {
        std::abort();
    }
}

inline std::string_view TextOf(const std::uint8_t *data, std::size_t size)
{
    return {reinterpret_cast<const char *>(data), size};
}

class Input
{
public:
    Input(const std::uint8_t *data, std::size_t size) : _rest(data, size) {}

    bool IsEmpty() const { return _rest.empty(); }
    // 0 at the end.
    std::uint8_t Byte()
    {
        const std::uint8_t byte = _rest.empty() ? std::uint8_t{0} : _rest.front();
        _rest = _rest.subspan(std::min<std::size_t>(1, _rest.size()));
        return byte;
    }
    // A size of two bytes, little endian, and so many bytes, or all that are left. A copy of its own, so that
    // the sanitizer sees reads beyond the end.
    std::vector<std::uint8_t> Part()
    {
        const std::size_t low = Byte();
        const std::size_t size =
            std::min<std::size_t>(low | static_cast<std::size_t>(Byte()) << 8, _rest.size());
        const std::vector<std::uint8_t> part(_rest.begin(),
                                             _rest.begin() + static_cast<std::ptrdiff_t>(size));
        _rest = _rest.subspan(size);
        return part;
    }

private:
    std::span<const std::uint8_t> _rest;
};

}  // namespace Fuzz
