#include "PayloadPool.h"

#include <rabit/base/Assert.h>

#include <cstring>
#include <new>

namespace Rabit::FastDds
{

namespace
{

// Buffers up to this size are kept for reuse, so that samples of one datagram need no
// allocation in the steady state.
constexpr std::uint32_t LargestKept = 64u << 10;
constexpr std::uint32_t SmallestBuffer = 512;
constexpr std::size_t MostKept = 1u << 20;  // bytes
// A history may hold its samples for ever, so a small one takes no large buffer.
constexpr std::uint32_t Loosest = 2;
constexpr std::align_val_t Alignment{16};

std::uint32_t CapacityFor(std::uint32_t size)
{
    if (size > LargestKept)
    {
        // The vendor keeps a list of missing fragments inside the buffer, rounded up to 4 bytes.
        return (size + 15u) & ~15u;
    }
    std::uint32_t capacity = SmallestBuffer;
    while (capacity < size)
    {
        capacity *= 2;
    }
    return capacity;
}

void Free(PayloadPool::Buffer buffer)
{
    ::operator delete(buffer.Data, Alignment);
}

}  // namespace

PayloadPool::~PayloadPool()
{
    for (const auto &buffer : _free)
    {
        Free(buffer);
    }
}

PayloadPool::Buffer PayloadPool::Acquire(std::uint32_t size)
{
    const std::uint32_t capacity = CapacityFor(size);
    if (capacity <= LargestKept)
    {
        const std::lock_guard lock(_mutex);
        for (std::size_t i = _free.size(); i-- > 0;)
        {
            if (_free[i].Capacity >= capacity && _free[i].Capacity <= Loosest * capacity)
            {
                const Buffer found = _free[i];
                _free[i] = _free.back();
                _free.pop_back();
                _kept -= found.Capacity;
                return found;
            }
        }
    }
    return {static_cast<std::uint8_t *>(::operator new(capacity, Alignment)), capacity};
}

void PayloadPool::Release(Buffer buffer)
{
    if (buffer.Capacity <= LargestKept)
    {
        const std::lock_guard lock(_mutex);
        if (_kept + buffer.Capacity <= MostKept)
        {
            _free.push_back(buffer);
            _kept += buffer.Capacity;
            return;
        }
    }
    Free(buffer);
}

void PayloadPool::Adopt(Buffer buffer, std::uint32_t length, Change &change)
{
    Fill(change.serializedPayload, buffer, length);
    Own(change);
}

void PayloadPool::Fill(Payload &payload, Buffer buffer, std::uint32_t length)
{
    _held += buffer.Capacity;
    payload.data = buffer.Data;
    payload.max_size = buffer.Capacity;
    payload.length = length;
    payload.pos = 0;
}

bool PayloadPool::Take(std::uint32_t size, Payload &payload)
{
    if (size > MaxSample || _held + size > MostArriving)
    {
        _onRefused();
        return false;
    }
    try
    {
        Fill(payload, Acquire(size), size);
        return true;
    }
    catch (const std::bad_alloc &)
    {
        return false;
    }
}

bool PayloadPool::TakeCopy(const Payload &data, Payload &payload)
{
    // The data lies in the receiving thread's buffer: this copy is the one that every RTPS reader makes.
    if (!Take(data.length, payload))
    {
        return false;
    }
    payload.encapsulation = data.encapsulation;
    if (data.length > 0)
    {
        std::memcpy(payload.data, data.data, data.length);
    }
    return true;
}

void PayloadPool::GiveBack(Payload &payload)
{
    RABIT_ASSERT(payload.max_size <= _held);
    _held -= payload.max_size;
    Release({payload.data, payload.max_size});
    payload.data = nullptr;
    payload.max_size = 0;
    payload.length = 0;
    payload.pos = 0;
}

}  // namespace Rabit::FastDds
