#pragma once

#include <algorithm>
#include <cstdint>

namespace Rabit
{

// Counts the posts of one local message that is sent, and the posts that were never sent, since a newer one
// came first. Not thread-safe.
class PostCount
{
public:
    // Begins to count. `posts`: of the name until now. The last one may be there still, and is the first.
    void Begin(std::uint64_t posts) { _before = posts == 0 ? 0 : posts - 1; }
    // A new value was fetched. `posts`: of the name before the fetch.
    void Fetched(std::uint64_t posts) { _offered = posts - _before; }
    // The fetched value was sent, or never can be.
    void Taken() { ++_taken; }

    // `waits`: true if a fetched value waits to be sent.
    std::uint64_t Offered(bool waits) const { return std::max(_offered, Kept(waits)); }
    std::uint64_t Replaced(bool waits) const { return Offered(waits) - Kept(waits); }

private:
    std::uint64_t Kept(bool waits) const { return _taken + (waits ? 1 : 0); }

    std::uint64_t _before = 0;
    std::uint64_t _offered = 0;
    std::uint64_t _taken = 0;
};

}  // namespace Rabit
