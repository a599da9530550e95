#include "queues/LinkPayloadPool.h"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

namespace Rabit
{
namespace
{

constexpr std::size_t KeptBytes = 256 * 1024;  // of each size
constexpr std::size_t KeptAtLeast = 2;
constexpr std::size_t KeptBlocks = 2048;

// False, and then nothing is kept, if there is no memory for the list itself.
template <class T>
bool Keep(std::vector<T> &kept, T &&value) noexcept
{
    try
    {
        kept.push_back(std::forward<T>(value));
        return true;
    }
    catch (const std::bad_alloc &)
    {
        return false;
    }
}

// The binary logarithm of the size of the memory for `size` bytes.
std::size_t BitsFor(std::size_t size, std::size_t smallest)
{
    return std::max<std::size_t>(size > 1 ? static_cast<std::size_t>(std::bit_width(size - 1)) : 0, smallest);
}

}  // namespace

class LinkPayloadPool::Pooled final : public LinkBytes
{
public:
    Pooled(std::shared_ptr<LinkPayloadPool> pool, Memory memory, std::size_t size)
        : LinkBytes(std::move(memory), size), _pool(std::move(pool))
    {
    }
    ~Pooled() { _pool->GiveBack(GiveUp(), Size()); }
    Pooled(const Pooled &) = delete;
    Pooled &operator=(const Pooled &) = delete;

private:
    const std::shared_ptr<LinkPayloadPool> _pool;
};

// Allocates objects of one type only, a Pooled together with its reference counts: so all blocks are equally
// large.
template <class T>
struct LinkPayloadPool::Allocator
{
    using value_type = T;

    explicit Allocator(std::shared_ptr<LinkPayloadPool> pool) : Pool(std::move(pool)) {}
    template <class Other>
    Allocator(const Allocator<Other> &other) : Pool(other.Pool)
    {
    }
    T *allocate(std::size_t count) { return static_cast<T *>(Pool->TakeBlock(count * sizeof(T))); }
    void deallocate(T *block, std::size_t /*count*/) noexcept { Pool->GiveBackBlock(block); }
    template <class Other>
    bool operator==(const Allocator<Other> &other) const
    {
        return Pool == other.Pool;
    }

    std::shared_ptr<LinkPayloadPool> Pool;
};

LinkPayloadPool::~LinkPayloadPool()
{
    for (void *block : _blocks)
    {
        ::operator delete(block);
    }
}

std::shared_ptr<LinkBytes> LinkPayloadPool::Make(std::size_t size)
{
    const std::shared_ptr<LinkPayloadPool> self = shared_from_this();
    return std::allocate_shared<Pooled>(Allocator<Pooled>(self), self, TakeMemory(size), size);
}

LinkPayloadPool::Memory LinkPayloadPool::TakeMemory(std::size_t size)
{
    const std::size_t bits = BitsFor(size, SmallestBits);
    if (bits > LargestBits)
    {
        return std::make_unique_for_overwrite<std::uint8_t[]>(size);
    }
    {
        const std::lock_guard lock(_mutex);
        std::vector<Memory> &kept = _memory[bits];
        if (!kept.empty())
        {
            Memory memory = std::move(kept.back());
            kept.pop_back();
            return memory;
        }
    }
    return std::make_unique_for_overwrite<std::uint8_t[]>(std::size_t{1} << bits);
}

void LinkPayloadPool::GiveBack(Memory memory, std::size_t size) noexcept
{
    const std::size_t bits = BitsFor(size, SmallestBits);
    if (bits > LargestBits)
    {
        return;
    }
    const std::lock_guard lock(_mutex);
    std::vector<Memory> &kept = _memory[bits];
    if (kept.size() < std::max(KeptBytes >> bits, KeptAtLeast))
    {
        Keep(kept, std::move(memory));
    }
}

void *LinkPayloadPool::TakeBlock(std::size_t size)
{
    {
        const std::lock_guard lock(_mutex);
        if (!_blocks.empty())
        {
            void *block = _blocks.back();
            _blocks.pop_back();
            return block;
        }
    }
    return ::operator new(size);
}

void LinkPayloadPool::GiveBackBlock(void *block) noexcept
{
    const std::lock_guard lock(_mutex);
    if (_blocks.size() >= KeptBlocks || !Keep(_blocks, std::move(block)))
    {
        ::operator delete(block);
    }
}

}  // namespace Rabit
