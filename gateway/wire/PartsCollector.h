#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace Rabit
{

// Puts parts together, in whatever order they come and however often. Uses the memory of the whole, which the
// caller has bounded, and an eighth more.
class PartsCollector
{
public:
    // Begins anew, with a whole of so many bytes.
    void Begin(std::size_t size);
    std::size_t Size() const { return _bytes.size(); }
    // The part must lie within the whole.
    void Add(std::size_t first, std::span<const std::uint8_t> bytes);
    bool IsComplete() const { return _lacking == 0; }
    const std::vector<std::uint8_t> &Bytes() const { return _bytes; }
    // The first byte that is lacking; Size() if none is.
    std::size_t FirstLacking() const;

private:
    std::vector<std::uint8_t> _bytes;
    std::vector<bool> _have;
    std::size_t _lacking = 0;  // how many bytes
};

}  // namespace Rabit
