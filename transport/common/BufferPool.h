#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace Rabit
{

// Memory for samples. Buffers of up to 64 kB are kept for the next ones of about that size: 1 MB at most of
// the largest ones, 3 MB in all. So samples of one datagram need no allocation in the steady state. Larger
// buffers are freed after use. Thread-safe.
class BufferPool
{
public:
    struct Buffer
    {
        std::uint8_t *Data = nullptr;  // aligned to 16
        std::uint32_t Capacity = 0;
    };

    BufferPool() = default;
    ~BufferPool();
    BufferPool(const BufferPool &) = delete;
    BufferPool &operator=(const BufferPool &) = delete;

    // A buffer for at least `size` bytes, and at most twice as many or 128. Throws std::bad_alloc.
    Buffer Acquire(std::uint32_t size);
    // Only buffers of this pool.
    void Release(Buffer buffer) noexcept;

private:
    static constexpr std::size_t SmallestBits = 7;
    static constexpr std::size_t LargestBits = 16;

    struct Free
    {
        Free *Next;
    };

    std::mutex _mutex;
    std::array<Free *, LargestBits + 1> _free{};       // by the binary logarithm of the capacity; guarded
    std::array<std::size_t, LargestBits + 1> _kept{};  // bytes in them; guarded
};

}  // namespace Rabit
