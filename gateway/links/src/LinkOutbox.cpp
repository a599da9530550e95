#include "LinkOutbox.h"

#include <algorithm>
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

double LinkOutbox::Fill() const
{
    const auto of = [](std::size_t used, std::size_t room)
    { return static_cast<double>(used) / static_cast<double>(std::max<std::size_t>(room, 1)); };
    return std::min(std::max(of(Count(), _options.Capacity), of(_bytes, _options.CapacityBytes)), 1.0);
}

void LinkOutbox::Add(OutboxMessage message)
{
    _bytes += message.Bytes;
    _waiting.PushBack(std::move(message));
}

std::size_t LinkOutbox::BytesToCut(std::size_t enough, std::size_t forEach) const
{
    std::size_t bytes = IsInPart() ? Next().Bytes - Next().Cut + forEach : 0;
    for (std::size_t i = 0; i < _waiting.Size() && bytes < enough; ++i)
    {
        bytes += _waiting[i].Bytes + forEach;
    }
    return bytes;
}

std::uint64_t LinkOutbox::Cut(std::size_t bytes)
{
    if (!IsInPart())
    {
        _sent.PushBack(_waiting.PopFront());
        _sent[_sent.Size() - 1].First = _nextSequence;
        ++_nextMessage;
    }
    OutboxMessage &message = _sent[_sent.Size() - 1];
    _parts.PushBack({.Message = _nextMessage - 1, .Offset = message.Cut, .Length = bytes});
    message.Cut += bytes;
    message.IsWhole = message.MayArrive = message.Cut == message.Bytes;
    message.End = ++_nextSequence;
    return _nextSequence - 1;
}

std::uint64_t LinkOutbox::CutSkip()
{
    OutboxMessage &message = _sent[_sent.Size() - 1];
    _parts.PushBack({.Message = _nextMessage - 1, .Offset = message.Cut});
    message.IsWhole = true;
    message.End = ++_nextSequence;
    return _nextSequence - 1;
}

OutboxMessage LinkOutbox::TakeSent()
{
    if (_sent.Front().IsSettled)
    {
        --_settled;
    }
    else
    {
        _bytes -= _sent.Front().Bytes;
    }
    return _sent.PopFront();
}

const OutboxMessage *LinkOutbox::FirstUnsettled() const
{
    return _settled < _sent.Size() ? &_sent[_settled] : nullptr;
}

OutboxMessage *LinkOutbox::FirstUnsettled()
{
    return _settled < _sent.Size() ? &_sent[_settled] : nullptr;
}

void LinkOutbox::Settle(OutboxMessage &message)
{
    message.IsSettled = true;
    message.IsSkipped = true;
    message.Payload.reset();
    _bytes -= message.Bytes;
    ++_settled;
}

OutboxMessage LinkOutbox::TakeWaiting()
{
    _bytes -= _waiting.Front().Bytes;
    return _waiting.PopFront();
}

void LinkOutbox::ReturnLastSent()
{
    OutboxMessage message = _sent.PopBack();
    --_nextMessage;
    message.First = message.End = 0;
    message.Cut = 0;
    message.IsWhole = message.IsSkipped = message.MayArrive = false;
    _waiting.PushFront(std::move(message));
}

}  // namespace Rabit
