#include "LinkReceiver.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace Rabit
{

namespace
{

// Two monotonic clocks differ by less than the time passed divided by this. Each is adjusted by at most 500
// ppm (the limit of the kernel's clock discipline).
constexpr std::int64_t DriftPart = 990;

}  // namespace

LinkReceiver::LinkReceiver(LinkContext &context, std::string source, std::string queue)
    : _context(context),
      _source(std::move(source)),
      _queue(std::move(queue)),
      _kept(context.Settings.ReorderBytes, context.Settings.ReorderBytesOfNode, context.ReorderBytes),
      _assembly(context.AssemblyMemory)
{
}

void LinkReceiver::OnData(const LinkFrame &frame, LinkTime ackDelay, LinkTime now)
{
    _link = frame.Data.Link;
    // Rule R3: a new stream is opened only if this frame is younger than the session it replaces.
    if (frame.SenderLife != _senderLife)
    {
        if (!MayOpen(frame, now))
        {
            ++_counters.Stale;
            AcknowledgeBy(now);
            return;
        }
        Open(frame, now);
    }
    _oldest = std::max(_oldest, std::min(frame.Data.Oldest, _cumulative + 1));
    for (const LinkItem &item : frame.Data.Items)
    {
        OnItem(frame, item, now + ackDelay, now);
    }
    if (frame.Ask || _unacknowledged >= _context.Settings.AckEvery ||
        _unacknowledgedBytes >= _context.Settings.AckEveryBytes)
    {
        AcknowledgeBy(now);
    }
}

bool LinkReceiver::MayOpen(const LinkFrame &frame, LinkTime now) const
{
    return frame.Echo.Clock == _context.Clock && frame.Echo.Time <= now.count() &&
           (!HasSession() || frame.Echo.Time > _openedAt.count());
}

void LinkReceiver::Open(const LinkFrame &frame, LinkTime now)
{
    DropSession();
    _senderLife = frame.SenderLife;
    _cumulative = frame.Data.Oldest - 1;
    _oldest = frame.Data.Oldest;
    _openedAt = now;
    ++_counters.SessionsOpened;
    // The sender knows no credit yet and waits for it.
    AcknowledgeBy(now);
}

void LinkReceiver::DropSession()
{
    _senderLife = 0;
    _cumulative = 0;
    _oldest = 0;
    _history.Clear();
    _openedAt = LinkTime(0);
    _types.clear();
    _kept.Clear();
    _assembly.Drop();
    _unacknowledged = 0;
    _unacknowledgedBytes = 0;
    _waits = false;
    _heldBack = false;
    _toldCredit = 0;
    _noMemory = false;
    _givenOut = 0;
    _prepared.reset();
}

void LinkReceiver::DropBeyondGap()
{
    _kept.DropBeyondGap(_cumulative);
}

// A message that is complete here may still go into the queue.
void LinkReceiver::SourceEnded()
{
    DropBeyondGap();
    if (_kept.Empty())
    {
        _assembly.Drop();
        _noMemory = false;
        _waits = false;
    }
}

void LinkReceiver::OnItem(const LinkFrame &frame, const LinkItem &item, LinkTime soon, LinkTime now)
{
    AcknowledgeBy(soon);
    // Rule R4: seen before -> acknowledge only.
    if (item.Through <= _cumulative)
    {
        ++_counters.Duplicates;
        AcknowledgeBy(now + _context.Settings.AckDelay);
        return;
    }
    if (item.Through > _cumulative + LinkWindowParts)
    {
        ++_counters.NotKept;
        return;
    }
    const ReceivedPart part{.Sequence = item.Sequence,
                            .Through = item.Through,
                            .Flags = item.Flags,
                            .AliveUntil = AliveUntil(item, frame.Echo, now),
                            .Type = TypeOf(item),
                            .Size = item.Size,
                            .Payload = item.Payload};
    if (part.Sequence > _cumulative + 1)
    {
        if (part.AliveUntil > now)
        {
            Keep(part);
        }
        // The sender soon hears of the gap.
        AcknowledgeBy(now + _context.Settings.AckDelay);
        return;
    }
    ++_unacknowledged;
    _unacknowledgedBytes += part.Payload.size();
    switch (Consume(part, now))
    {
        case Result::Consumed:
            ConsumeKept(now);
            break;
        case Result::NotNow:
            Keep(part);
            break;
        case Result::Late:
            break;
    }
}

// Rules R5 and R6: the frame was made after the echoed reading of our clock plus the time that the sender
// held it; so its transit took at most the time since then.
LinkTime LinkReceiver::AliveUntil(const LinkItem &item, const LinkEcho &echo, LinkTime now) const
{
    if ((item.Flags & LinkFlagSkip) != 0 || (item.Flags & LinkFlagLast) == 0 || item.TtlLeft == LinkNoExpiry)
    {
        return LinkNever;
    }
    if (echo.Clock != _context.Clock || echo.Time > now.count())
    {
        return LinkTime(0);
    }
    const std::int64_t passed = now.count() - echo.Time;
    const std::int64_t transit = std::max<std::int64_t>(passed - echo.HeldFor, 0) + passed / DriftPart;
    const std::int64_t left = item.TtlLeft - transit;
    return now + LinkTime(left - left / DriftPart);
}

// Rule R4: the sender sends a type's name until it knows that the number is known here.
std::string_view LinkReceiver::TypeOf(const LinkItem &item)
{
    if ((item.Flags & LinkFlagFirst) == 0 || item.TypeNumber >= LinkMaxTypes)
    {
        return item.Type;
    }
    if (!item.Type.empty())
    {
        std::string &name = _types[item.TypeNumber];
        if (name != item.Type)
        {
            // Deliver refuses a message without a type name, so other names need not be remembered.
            name.assign(_context.Queues.AcceptsType(_queue, item.Type) ? item.Type : std::string_view());
        }
        return name;
    }
    const auto found = _types.find(item.TypeNumber);
    return found == _types.end() ? std::string_view() : found->second;
}

void LinkReceiver::Keep(const ReceivedPart &part)
{
    if (!_noMemory && _kept.Keep(part))
    {
        ++_counters.Kept;
    }
    else
    {
        ++_counters.NotKept;
    }
}

void LinkReceiver::ConsumeKept(LinkTime now, bool turn)
{
    const std::uint64_t before = _counters.Delivered;
    for (_kept.DropThrough(_cumulative); !_kept.Empty(); _kept.DropThrough(_cumulative))
    {
        if (turn && _counters.Delivered != before)
        {
            return;
        }
        const ReceivedPart part = _kept.First();
        if (part.Sequence > _cumulative + 1)
        {
            return;
        }
        const Result result = Consume(part, now);
        if (result == Result::NotNow)
        {
            return;
        }
        if (result == Result::Late)
        {
            _kept.DropFirst();
            return;
        }
    }
}

void LinkReceiver::Advance(const ReceivedPart &part, OutcomeHistory::Entry entry)
{
    for (; _cumulative < part.Through; ++_cumulative)
    {
        _history.Set(_cumulative + 1, entry);
    }
    _waits = false;
    _heldBack = false;
    _noMemory = false;
    _givenOut = 0;
    _prepared.reset();
}

void LinkReceiver::OnRoom(std::size_t waiting, LinkTime now)
{
    _sharers = waiting;
    if (_heldBack && Credit() > _toldCredit)
    {
        AcknowledgeBy(now + _context.Settings.AckDelay);
    }
}

bool LinkReceiver::TakeTurn(LinkTime now)
{
    const std::uint64_t delivered = _counters.Delivered;
    const std::uint64_t before = _cumulative;
    const LinkTime ackAt = _ackAt;
    ConsumeKept(now, true);
    if (_cumulative != before)
    {
        AcknowledgeBy(now + _context.Settings.AckDelay);
    }
    else if (_heldBack)
    {
        _ackAt = ackAt;  // another link took the room: no news for the sender
    }
    return _counters.Delivered != delivered;
}

void LinkReceiver::Prepared(std::uint64_t senderLife, std::uint64_t number, std::shared_ptr<void> prepared,
                            LinkTime now)
{
    if (senderLife != _senderLife || number != _givenOut || _prepared)
    {
        return;
    }
    _givenOut = prepared ? number : 0;
    _prepared = std::move(prepared);
    const std::uint64_t before = _cumulative;
    ConsumeKept(now);
    if (_cumulative != before)
    {
        AcknowledgeBy(now + _context.Settings.AckDelay);
    }
}

void LinkReceiver::AcknowledgeBy(LinkTime when)
{
    _ackAt = std::min(_ackAt, when);
}

void LinkReceiver::Describe(LinkAck &ack, std::uint64_t sourceLife) const
{
    ack = {};
    ack.Link = _link;
    ack.Open = HasSessionOf(sourceLife);
    if (ack.Open)
    {
        ack.Cumulative = _cumulative;
        ack.Oldest =
            std::max(_oldest, _cumulative + 1 - std::min<std::uint64_t>(_cumulative, LinkWindowParts));
        ack.Delivered = _history.Delivered();
        ack.Refused = _history.Refused();
        if (!_kept.Empty())
        {
            ack.Held = _kept.HeldAfter(_cumulative);
        }
        ack.Credit = Credit();
    }
}

// One complete message may wait here for its turn. So a link whose messages are large takes part in the turns
// of a full queue.
std::uint32_t LinkReceiver::Credit() const
{
    const std::size_t share =
        std::clamp<std::size_t>(_context.Queues.Room(_queue) / _sharers, 1, LinkMaxWindow);
    return _noMemory ? 0 : static_cast<std::uint32_t>(share);
}

void LinkReceiver::Acknowledged(const LinkAck &ack)
{
    _heldBack = ack.Open ? ack.Credit <= 1 : _heldBack;
    _toldCredit = ack.Credit;
    _sharers = 1;
    _ackAt = LinkNever;
    _unacknowledged = 0;
    _unacknowledgedBytes = 0;
    ++_counters.AcksSent;
}

LinkReceiverCounters LinkReceiver::Counters() const
{
    LinkReceiverCounters counters = _counters;
    counters.HeldBack = HasSession() && _waits;
    counters.KeptBytes = _kept.Bytes();
    counters.AssemblyBytes = _assembly.Size();
    return counters;
}

std::string LinkReceiver::Describe() const
{
    std::ostringstream out;
    out << "from " << _source << '/' << _queue << ": link " << _link << " session " << _senderLife << " cum "
        << _cumulative << " oldest " << _oldest << " opened at " << _openedAt.count() << " ack at "
        << _ackAt.count() << " unacknowledged " << _unacknowledged << (_heldBack ? " held back" : "")
        << (_waits ? " waits" : "") << " kept " << _kept.Bytes() << " assembly " << _assembly.Size()
        << " types " << _types.size() << " delivered " << std::hex;
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
