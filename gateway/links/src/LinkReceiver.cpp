#include "LinkReceiver.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace Rabit
{

namespace
{

// Two monotonic clocks, each adjusted by at most 500 ppm (what the kernel's clock discipline may do), differ
// by less than this part of the time passed.
constexpr std::int64_t DriftPart = 990;

}  // namespace

LinkReceiver::LinkReceiver(LinkContext &context, const std::uint64_t &ownLife, std::string source,
                           std::string queue)
    : _context(context), _ownLife(ownLife), _source(std::move(source)), _queue(std::move(queue))
{
}

void LinkReceiver::OnData(const LinkData &data, LinkTime now)
{
    // Rule R1: not for this life -> acknowledge only. (The node has already raised its incarnation if need
    // be.)
    if (data.ReceiverIncarnation != _ownLife)
    {
        ++_counters.Stale;
        AcknowledgeBy(now);
        return;
    }
    // Rule R2: from an older life of the sender -> acknowledge only.
    if (HasSession() && data.SenderIncarnation < _senderIncarnation)
    {
        ++_counters.Stale;
        AcknowledgeBy(now);
        return;
    }
    // Rule R3: a new stream is opened only if this datagram is younger than the session it replaces.
    if (data.SenderIncarnation != _senderIncarnation)
    {
        if (!MayOpen(data, now))
        {
            ++_counters.Stale;
            AcknowledgeBy(now);
            return;
        }
        Open(data, now);
    }
    if (data.SentAt > _latestSentAt)
    {
        _latestSentAt = data.SentAt;
        _latestCameAt = now;
    }
    std::uint64_t sequence = data.First;
    for (const LinkItem &item : data.Items)
    {
        // Rule R4: seen before, or one before it is missing -> acknowledge only.
        if (sequence != _cumulative + 1)
        {
            ++_counters.Duplicates;
            AcknowledgeBy(now + _context.Settings.AckDelay);
        }
        else if (!Consume(data, item, now))
        {
            break;
        }
        ++sequence;
    }
}

bool LinkReceiver::MayOpen(const LinkData &data, LinkTime now) const
{
    return data.Echo.Clock == _context.Settings.Clock && data.Echo.Time <= now.count() &&
           (!HasSession() || data.Echo.Time > _openedAt.count());
}

void LinkReceiver::Open(const LinkData &data, LinkTime now)
{
    _senderIncarnation = data.SenderIncarnation;
    _cumulative = data.Base - 1;
    _history.Clear();
    _openedAt = now;
    _latestSentAt = 0;
    _unacknowledged = 0;
    _unacknowledgedBytes = 0;
    _heldBack = false;
    ++_counters.SessionsOpened;
    // The sender knows no credit yet and waits for it.
    AcknowledgeBy(now);
}

// Rules R5 to R8 for the message after the last one consumed. False: it was not consumed, nor can be those
// after it.
bool LinkReceiver::Consume(const LinkData &data, const LinkItem &item, LinkTime now)
{
    AcknowledgeBy(now + _context.Settings.AckDelay);
    _unacknowledgedBytes += item.Payload.size();
    if ((item.Flags & LinkFlagSkip) != 0)
    {
        ++_counters.Skipped;
        Advance(OutcomeHistory::Entry::Skipped);
        return true;
    }
    if (!IsInTime(item, data.Echo, now))
    {
        // The sender gets a fresh token with the acknowledgement, and sends the message again with less time
        // left, or as SKIP: so a loose bound on the transit never makes a message expire that has time left.
        ++_counters.HeldBackLate;
        AcknowledgeBy(now);
        return false;
    }
    const bool redelivered = (item.Flags & LinkFlagRedelivered) != 0;
    switch (_context.Queues.Deliver(_source, _queue, item.Type, item.Payload, redelivered))
    {
        case LocalQueueResult::Full:
            // Rule R7: acknowledge, no credit, do not advance. OnRoom makes room known.
            ++_counters.HeldBackFull;
            _heldBack = true;
            AcknowledgeBy(now);
            return false;
        case LocalQueueResult::Ok:
            // Rule R8.
            ++_counters.Delivered;
            Advance(OutcomeHistory::Entry::Delivered);
            break;
        case LocalQueueResult::Unknown:
            ++_counters.RefusedUnknown;
            Advance(OutcomeHistory::Entry::Refused);
            break;
        case LocalQueueResult::WrongType:
            ++_counters.RefusedWrongType;
            Advance(OutcomeHistory::Entry::Refused);
            break;
        case LocalQueueResult::Undecodable:
            ++_counters.RefusedUndecodable;
            Advance(OutcomeHistory::Entry::Refused);
            break;
    }
    if (_unacknowledged >= _context.Settings.AckEvery ||
        _unacknowledgedBytes >= _context.Settings.AckEveryBytes)
    {
        AcknowledgeBy(now);
    }
    return true;
}

// Rules R5 and R6: the datagram was made after the echoed reading of our clock plus the time that the sender
// held it; so its transit took at most what has passed since.
bool LinkReceiver::IsInTime(const LinkItem &item, const LinkEcho &echo, LinkTime now) const
{
    if (item.TtlLeft == LinkNoExpiry)
    {
        return true;
    }
    if (echo.Clock != _context.Settings.Clock || echo.Time > now.count())
    {
        return false;
    }
    const std::int64_t passed = now.count() - echo.Time;
    const std::int64_t transit = std::max<std::int64_t>(passed - echo.HeldFor, 0) + passed / DriftPart;
    return item.TtlLeft > transit;
}

void LinkReceiver::Advance(OutcomeHistory::Entry entry)
{
    ++_cumulative;
    _history.Push(entry);
    ++_unacknowledged;
    _heldBack = false;
}

void LinkReceiver::OnRoom(LinkTime now)
{
    if (HasSession() && _heldBack)
    {
        AcknowledgeBy(now + _context.Settings.AckDelay);
    }
}

void LinkReceiver::DropSession()
{
    _senderIncarnation = 0;
    _cumulative = 0;
    _history.Clear();
    _openedAt = LinkTime(0);
    _latestSentAt = 0;
    _unacknowledged = 0;
    _unacknowledgedBytes = 0;
    _heldBack = false;
}

void LinkReceiver::AcknowledgeBy(LinkTime when)
{
    _ackAt = std::min(_ackAt, when);
}

void LinkReceiver::Run(std::uint64_t peerIncarnation, LinkTime now)
{
    if (now < _ackAt)
    {
        return;
    }
    LinkAck ack;
    ack.Source = _source;
    ack.Destination = _context.Settings.Node;
    ack.Queue = _queue;
    ack.ReceiverIncarnation = _ownLife;
    ack.SenderIncarnation = _senderIncarnation;
    ack.Cumulative = _cumulative;
    ack.Delivered = _history.Delivered();
    ack.Refused = _history.Refused();
    ack.Credit = static_cast<std::uint32_t>(std::min(_context.Queues.Room(_queue), LinkOutcomeBits));
    ack.Clock = _context.Settings.Clock;
    ack.Time = now.count();
    ack.YourIncarnation = peerIncarnation;
    ack.EchoSentAt = _latestSentAt;
    ack.EchoHeldFor = _latestSentAt == 0 ? 0 : (now - _latestCameAt).count();
    _heldBack = ack.Credit == 0;
    _ackAt = LinkNever;
    _unacknowledged = 0;
    _unacknowledgedBytes = 0;
    ++_counters.AcksSent;
    _context.Output.Send(ack);
}

LinkReceiverCounters LinkReceiver::Counters() const
{
    LinkReceiverCounters counters = _counters;
    counters.HeldBack = HasSession() && _heldBack;
    return counters;
}

std::string LinkReceiver::Describe() const
{
    std::ostringstream out;
    out << "from " << _source << '/' << _queue << ": session " << _senderIncarnation << " cum " << _cumulative
        << " opened at " << _openedAt.count() << " ack at " << _ackAt.count() << " unacknowledged "
        << _unacknowledged << (_heldBack ? " held back" : "") << " delivered " << std::hex;
    for (const std::uint64_t word : _history.Delivered())
    {
        out << word << ' ';
    }
    out << "refused ";
    for (const std::uint64_t word : _history.Refused())
    {
        out << word << ' ';
    }
    return out.str();
}

}  // namespace Rabit
