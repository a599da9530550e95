// The buffers of one writer or reader.
//
// It replaces the vendor's pool for three reasons: a writer encodes before it takes the vendor's lock, a
// buffer's size is bounded whatever a datagram claims, and large buffers are freed after use.
#pragma once

#include <rabit/transport/Transport.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

#include "Vendor.h"
#include "common/BufferPool.h"

namespace Rabit::FastDds
{

// Larger samples are neither sent nor accepted.
constexpr std::uint32_t MaxSample = LargestSample;

// Thread-safe.
class PayloadPool final : public Buffers
{
public:
    using Change = rtps::CacheChange_t;
    using Payload = rtps::SerializedPayload_t;

    using Buffer = BufferPool::Buffer;

    // `onRefused` is called, on the vendor's thread, if an arriving sample is larger than MaxSample, or
    // exceeds MostArriving.
    explicit PayloadPool(std::function<void()> onRefused) : _onRefused(std::move(onRefused)) {}

    // Limit for all samples together whose fragments are still arriving: the first fragment declares the size
    // of its sample, and the others may never come. Each of the two largest has room for the vendor's list.
    static constexpr std::size_t MostArriving = 2 * (std::size_t{MaxSample} + 16);

    // As those of BufferPool. The caller owns the buffer until it releases or adopts it.
    Buffer Acquire(std::uint32_t size) { return _buffers.Acquire(size); }
    void Release(Buffer buffer) { _buffers.Release(buffer); }
    // Makes the buffer the payload of a change that has none.
    void Adopt(Buffer buffer, std::uint32_t length, Change &change);

private:
    bool Take(std::uint32_t size, Payload &payload) override;
    bool TakeCopy(const Payload &data, Payload &payload) override;
    void GiveBack(Payload &payload) override;
    void Fill(Payload &payload, Buffer buffer, std::uint32_t length);

    const std::function<void()> _onRefused;
    BufferPool _buffers;
    std::atomic<std::size_t> _held = 0;  // bytes in changes
};

}  // namespace Rabit::FastDds
