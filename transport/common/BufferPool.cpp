#include "common/BufferPool.h"

#include <algorithm>
#include <bit>
#include <new>

namespace Rabit
{

namespace
{

// Of each capacity, so that a burst of one size leaves room for the others: these buffers, or these bytes if
// they are more.
constexpr std::size_t BuffersKept = 16, BytesKept = 1u << 17;
constexpr std::align_val_t Alignment{16};

}  // namespace

BufferPool::~BufferPool()
{
    for (Free *first : _free)
    {
        while (first != nullptr)
        {
            Free *const next = first->Next;
            ::operator delete(first, Alignment);
            first = next;
        }
    }
}

BufferPool::Buffer BufferPool::Acquire(std::uint32_t size)
{
    const auto needed = static_cast<std::size_t>(std::bit_width(std::max<std::uint32_t>(size, 1) - 1));
    const std::size_t bits = std::max(needed, SmallestBits);
    if (bits > LargestBits)
    {
        const std::uint32_t capacity = (size + 15u) & ~15u;
        return {static_cast<std::uint8_t *>(::operator new(capacity, Alignment)), capacity};
    }
    const std::uint32_t capacity = 1u << bits;
    {
        const std::lock_guard lock(_mutex);
        if (Free *const first = _free[bits])
        {
            _free[bits] = first->Next;
            _kept[bits] -= capacity;
            return {reinterpret_cast<std::uint8_t *>(first), capacity};
        }
    }
    return {static_cast<std::uint8_t *>(::operator new(capacity, Alignment)), capacity};
}

void BufferPool::Release(Buffer buffer) noexcept
{
    if (buffer.Capacity <= 1u << LargestBits)
    {
        const auto bits = static_cast<std::size_t>(std::bit_width(buffer.Capacity) - 1);
        const std::lock_guard lock(_mutex);
        if (_kept[bits] < std::max(BuffersKept * buffer.Capacity, BytesKept))
        {
            _free[bits] = new (buffer.Data) Free{_free[bits]};
            _kept[bits] += buffer.Capacity;
            return;
        }
    }
    ::operator delete(buffer.Data, Alignment);
}

}  // namespace Rabit
