#pragma once

#include <rabit/gateway/links/LinkPayload.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace Rabit
{

// Makes payloads out of the memory of those that are no longer held. So a message in an outbox costs no
// allocation in the steady state. The kept memory is bounded: some hundred kilobytes for each power of two of
// sizes, and nothing above a megabyte. Thread-safe. Payloads may outlive the maker of the pool: they hold it.
class LinkPayloadPool final : public std::enable_shared_from_this<LinkPayloadPool>
{
public:
    // The pool must be held by a std::shared_ptr.
    std::shared_ptr<LinkBytes> Make(std::size_t size);

    ~LinkPayloadPool();
    LinkPayloadPool() = default;
    LinkPayloadPool(const LinkPayloadPool &) = delete;
    LinkPayloadPool &operator=(const LinkPayloadPool &) = delete;

private:
    class Pooled;
    template <class T>
    struct Allocator;

    static constexpr std::size_t SmallestBits = 6;
    static constexpr std::size_t LargestBits = 20;
    using Memory = LinkBytes::Memory;

    Memory TakeMemory(std::size_t size);
    void GiveBack(Memory memory, std::size_t size) noexcept;
    void *TakeBlock(std::size_t size);
    void GiveBackBlock(void *block) noexcept;

    std::mutex _mutex;
    std::array<std::vector<Memory>, LargestBits + 1> _memory;  // by the binary logarithm of the size
    std::vector<void *> _blocks;  // each a LinkBytes with the counts of its shared pointers
};

}  // namespace Rabit
