// The buffers of one writer or reader.
//
// An own pool instead of the vendor's, for three reasons: a writer encodes before it takes the vendor's lock,
// a buffer's size is bounded whatever a datagram claims, and large buffers are given back when they are done
// with.
#pragma once

#include <fastdds/rtps/common/CacheChange.h>
#include <fastdds/rtps/history/IPayloadPool.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace Rabit::FastDds
{

// Larger samples are neither sent nor accepted.
constexpr std::uint32_t MaxSample = 64u << 20;

// Thread-safe.
class PayloadPool final : public eprosima::fastrtps::rtps::IPayloadPool
{
public:
    using Change = eprosima::fastrtps::rtps::CacheChange_t;
    using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

    struct Buffer
    {
        std::uint8_t *Data = nullptr;  // aligned to 16
        std::uint32_t Capacity = 0;
    };

    // `onRefused` is called, on the vendor's thread, when a sample larger than MaxSample arrives.
    explicit PayloadPool(std::function<void()> onRefused) : _onRefused(std::move(onRefused)) {}
    ~PayloadPool() override;

    // A buffer for at least `size` bytes, which the caller owns until it releases or adopts it. Throws
    // std::bad_alloc.
    Buffer Acquire(std::uint32_t size);
    void Release(Buffer buffer);
    // Makes the buffer the payload of a change that has none.
    void Adopt(Buffer buffer, std::uint32_t length, Change &change);

    // IPayloadPool
    bool get_payload(std::uint32_t size, Change &change) override;
    bool get_payload(Payload &data, eprosima::fastrtps::rtps::IPayloadPool *&owner, Change &change) override;
    bool release_payload(Change &change) override;

private:
    const std::function<void()> _onRefused;
    std::mutex _mutex;
    std::vector<Buffer> _free;  // guarded by _mutex
};

}  // namespace Rabit::FastDds
