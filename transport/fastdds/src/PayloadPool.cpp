#include "PayloadPool.h"

#include <rabit/base/Assert.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace Rabit::FastDds
{

namespace
{

// Bytes that a change takes with its buffer: the vendor's change beside it has some 250.
std::size_t HeldBy(std::uint32_t capacity)
{
    constexpr std::uint32_t least = 512;
    return std::max(capacity, least);
}

}  // namespace

void PayloadPool::Adopt(Buffer buffer, std::uint32_t length, Change &change)
{
    Fill(change.serializedPayload, buffer, length);
    Own(change);
}

void PayloadPool::Fill(Payload &payload, Buffer buffer, std::uint32_t length)
{
    _held += HeldBy(buffer.Capacity);
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
        // The vendor keeps a list of missing fragments inside the buffer, and rounds its places up to 4
        // bytes.
        Fill(payload, _buffers.Acquire(size + 4), size);
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
    RABIT_ASSERT(HeldBy(payload.max_size) <= _held);
    _held -= HeldBy(payload.max_size);
    _buffers.Release({payload.data, payload.max_size});
    payload.data = nullptr;
    payload.max_size = 0;
    payload.length = 0;
    payload.pos = 0;
}

}  // namespace Rabit::FastDds
