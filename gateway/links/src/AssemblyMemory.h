#pragma once

#include <rabit/gateway/links/LinkTime.h>

#include <cstddef>

namespace Rabit
{

// How many bytes the beginnings of large messages may take on all links of a node. When they have taken all,
// one of them at a time may go on beyond it, so that they never all wait for each other: the bound is the
// limit and one largest message.
class AssemblyMemory
{
public:
    // One that does not go on for so long lets another one go on.
    static constexpr LinkTime Patience = std::chrono::seconds(10);

    explicit AssemblyMemory(std::size_t limit) : _limit(limit) {}

    // `who` wants so many bytes more. Whether it gets them.
    bool Take(const void *who, std::size_t bytes, LinkTime now);
    // `who` has no message any more, and gives so many bytes back.
    void Give(const void *who, std::size_t bytes);
    std::size_t Used() const { return _used; }

private:
    const std::size_t _limit;
    std::size_t _used = 0;
    const void *_favoured = nullptr;
    LinkTime _favouredAt{0};
};

}  // namespace Rabit
