// Rules R6 to R8: consumes or holds back the part whose turn it is.
#include "LinkReceiver.h"

namespace Rabit
{

namespace
{

bool Has(const ReceivedPart &part, std::uint8_t flag)
{
    return (part.Flags & flag) != 0;
}

}  // namespace

LinkReceiver::Result LinkReceiver::Consume(const ReceivedPart &part, LinkTime now)
{
    if (Has(part, LinkFlagSkip))
    {
        _assembly.Drop();
        ++_counters.Skipped;
        Advance(part, OutcomeHistory::Entry::Skipped);
        return Result::Consumed;
    }
    return Has(part, LinkFlagLast) ? ConsumeLast(part, now) : ConsumePiece(part, now);
}

// Consumes a part that is not the last one of its message.
LinkReceiver::Result LinkReceiver::ConsumePiece(const ReceivedPart &part, LinkTime now)
{
    if (Has(part, LinkFlagFirst) && part.Size <= _context.Settings.LargestMessage)
    {
        _assembly.Begin(part.Type, part.Size);
    }
    else if (Has(part, LinkFlagFirst) || !_assembly.IsOpen())
    {
        _assembly.BeginRefused();
    }
    if (!Append(part, now))
    {
        return HoldBack(now);
    }
    Advance(part, OutcomeHistory::Entry::Delivered);
    return Result::Consumed;
}

// Returns false if there is no memory for the part now. As with a full queue, the sender probes until there
// is.
bool LinkReceiver::Append(const ReceivedPart &part, LinkTime now)
{
    _noMemory = !_assembly.Append(part.Payload, now);
    _counters.HeldBackMemory += _noMemory ? 1 : 0;
    return !_noMemory;
}

// Rule R7: acknowledge, do not advance.
LinkReceiver::Result LinkReceiver::HoldBack(LinkTime now)
{
    _waits = true;
    _heldBack = true;
    AcknowledgeBy(now);
    return Result::NotNow;
}

LinkReceiver::Result LinkReceiver::ConsumeLast(const ReceivedPart &part, LinkTime now)
{
    if (part.Sequence == _givenOut && !_prepared)
    {
        return Result::NotNow;  // the driver reads its bytes
    }
    if (part.AliveUntil <= now)
    {
        // The sender gets a fresh token with the acknowledgement, and sends the part again with less time
        // left, or as SKIP: so a loose bound on the transit never makes a message expire that has time left.
        ++_counters.HeldBackLate;
        AcknowledgeBy(now);
        return Result::Late;
    }
    if (Has(part, LinkFlagFirst))
    {
        _assembly.Drop();
        return Deliver(part, part.Type, part.Payload, nullptr, now);
    }
    if (!_assembly.IsOpen())
    {
        _assembly.BeginRefused();
    }
    if (!Append(part, now))
    {
        return HoldBack(now);
    }
    if (!_assembly.IsComplete())
    {
        _assembly.Drop();
        ++_counters.RefusedUndecodable;
        Advance(part, OutcomeHistory::Entry::Refused);
        return Result::Consumed;
    }
    const Result result = Deliver(part, _assembly.Type(), _assembly.Bytes(), _assembly.Owner(), now);
    if (result == Result::Consumed)
    {
        _assembly.Drop();
    }
    else
    {
        _assembly.TakeBack(part.Payload.size());
    }
    return result;
}

LinkReceiver::Result LinkReceiver::Deliver(const ReceivedPart &part, std::string_view type,
                                           std::span<const std::uint8_t> payload, const LinkPayload &owner,
                                           LinkTime now)
{
    const LocalQueueResult result =
        type.empty() ? LocalQueueResult::WrongType
                     : _context.Queues.Deliver({.Source = _source,
                                                .Queue = _queue,
                                                .Type = type,
                                                .SenderLife = _senderLife,
                                                .Number = part.Sequence,
                                                .Payload = payload,
                                                .Owner = owner,
                                                .Redelivered = Has(part, LinkFlagRedelivered),
                                                .Prepared = _prepared});
    switch (result)
    {
        case LocalQueueResult::Full:
            ++_counters.HeldBackFull;
            return HoldBack(now);  // OnRoom makes room known
        case LocalQueueResult::Later:
            _givenOut = part.Sequence;
            _prepared.reset();
            return Result::NotNow;
        case LocalQueueResult::Ok:
            // Rule R8.
            ++_counters.Delivered;
            Advance(part, OutcomeHistory::Entry::Delivered);
            return Result::Consumed;
        case LocalQueueResult::Unknown:
            ++_counters.RefusedUnknown;
            break;
        case LocalQueueResult::WrongType:
            ++_counters.RefusedWrongType;
            break;
        case LocalQueueResult::Undecodable:
            ++_counters.RefusedUndecodable;
            break;
    }
    Advance(part, OutcomeHistory::Entry::Refused);
    return Result::Consumed;
}

}  // namespace Rabit
