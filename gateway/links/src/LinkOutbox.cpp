#include "LinkOutbox.h"

#include <utility>

namespace Rabit
{

LinkRefusal LinkOutbox::Check(std::size_t bytes) const
{
    if (bytes > _options.CapacityBytes)
    {
        return LinkRefusal::TooLarge;
    }
    if (Count() >= _options.Capacity)
    {
        return LinkRefusal::FullByCount;
    }
    if (bytes > _options.CapacityBytes - _bytes)
    {
        return LinkRefusal::FullByBytes;
    }
    return LinkRefusal::None;
}

void LinkOutbox::Add(OutboxMessage message)
{
    _bytes += message.Bytes;
    _waiting.PushBack(std::move(message));
}

void LinkOutbox::NumberFirstWaiting()
{
    _sent.PushBack(_waiting.PopFront());
    ++_nextSequence;
}

OutboxMessage LinkOutbox::TakeSent()
{
    _bytes -= _sent.Front().Bytes;
    return _sent.PopFront();
}

OutboxMessage LinkOutbox::TakeWaiting()
{
    _bytes -= _waiting.Front().Bytes;
    return _waiting.PopFront();
}

void LinkOutbox::ReturnLastSent()
{
    _waiting.PushFront(_sent.PopBack());
}

}  // namespace Rabit
