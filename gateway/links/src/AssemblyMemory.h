#pragma once

#include <rabit/gateway/links/LinkTime.h>

#include <cstddef>
#include <vector>

namespace Rabit
{

class Assembly;

// Bounds the bytes that the beginnings of large messages take on all links of a node.
//
// At the limit, a beginning to which nothing was added for Stalled is refused in favour of one that grows:
// its sender is gone. If none is stalled, one beginning at a time may grow beyond the limit, so that they
// never all wait for each other. The bound is the limit and one largest message.
class AssemblyMemory
{
public:
    // The favoured beginning loses its favour when it did not grow for this long.
    static constexpr LinkTime Patience = std::chrono::seconds(10);
    // Longer than outages that a fleet flies through.
    static constexpr LinkTime Stalled = std::chrono::minutes(5);

    explicit AssemblyMemory(std::size_t limit) : _limit(limit) {}

    // Takes `bytes` more bytes for `who`. Returns true if it gets them.
    bool Take(Assembly &who, std::size_t bytes, LinkTime now);
    // `who` has no message any more, and returns `bytes` bytes.
    void Give(Assembly &who, std::size_t bytes);
    std::size_t Used() const { return _used; }

private:
    void RefuseStalled(std::size_t bytes, const Assembly &except, LinkTime now);

    const std::size_t _limit;
    std::size_t _used = 0;
    std::vector<Assembly *> _users;  // that have bytes
    const Assembly *_favoured = nullptr;
    LinkTime _favouredAt{0};
};

}  // namespace Rabit
