#include "LinkSender.h"

#include "OutcomeHistory.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace Rabit
{

namespace
{

// What a LinkData takes on the wire beside its names, and a message beside its type and payload: numbers,
// flags, lengths and alignment, rounded up.
constexpr std::size_t DatagramOverhead = 96;
constexpr std::size_t MessageOverhead = 32;

}  // namespace

LinkSender::LinkSender(LinkContext &context, const std::uint64_t &ownLife, std::string destination,
                       std::string queue, const LinkOptions &options)
    : _context(context),
      _ownLife(ownLife),
      _destination(std::move(destination)),
      _queue(std::move(queue)),
      _options(options),
      _outbox(_options),
      _window(_options, context.Settings.ShortRoundTrip),
      _allowed(_options.Window),
      _timer(context.Settings)
{
}

// Rule S1: full by count or bytes -> refuse, change nothing else.
LinkRefusal LinkSender::Enqueue(std::uint64_t id, const std::string &type, LinkPayload payload, LinkTime now)
{
    ExpireWaiting(now);
    const std::size_t bytes = payload ? payload->Size() : 0;
    const LinkRefusal refusal = _outbox.Check(bytes);
    switch (refusal)
    {
        case LinkRefusal::FullByCount:
            ++_counters.RefusedFullByCount;
            return refusal;
        case LinkRefusal::FullByBytes:
            ++_counters.RefusedFullByBytes;
            return refusal;
        case LinkRefusal::TooLarge:
            ++_counters.RefusedTooLarge;
            return refusal;
        default:
            break;
    }
    if (_outbox.Empty())
    {
        _resendAt = std::max(now, _lastSentAt + _timer.Timeout());
    }
    const LinkTime expiresAt = _options.Expire > LinkTime(0) ? now + _options.Expire : LinkNever;
    _outbox.Add(
        {.Id = id, .ExpiresAt = expiresAt, .Type = &type, .Payload = std::move(payload), .Bytes = bytes});
    ++_counters.Accepted;
    return LinkRefusal::None;
}

// Rule S2: without a token nothing is sent; else the window of unacknowledged messages from the front.
void LinkSender::Run(const PeerView &peer, LinkTime now)
{
    ExpireWaiting(now);
    if (_outbox.Empty() || !peer.Token.Known() || peer.Silent)
    {
        return;
    }
    if (now >= _resendAt)
    {
        OnResendTimer(now);
    }
    while (MaySendNext())
    {
        SendDatagram(peer, now);
    }
}

LinkTime LinkSender::NextDue(const PeerView &peer) const
{
    if (_outbox.Empty())
    {
        return LinkNever;
    }
    const LinkTime expiry = _outbox.HasWaiting() ? _outbox.FirstWaiting().ExpiresAt : LinkNever;
    if (!peer.Token.Known() || peer.Silent)
    {
        return expiry;
    }
    return MaySendNext() ? LinkTime(0) : std::min(expiry, _resendAt);
}

// A message that expires before it was ever sent needs no word from the receiver. All messages of a link live
// equally long, so the oldest is the first to expire.
void LinkSender::ExpireWaiting(LinkTime now)
{
    while (_outbox.HasWaiting() && now >= _outbox.FirstWaiting().ExpiresAt)
    {
        const OutboxMessage message = _outbox.TakeWaiting();
        Report(message, message.Redelivered ? LinkOutcome::InDoubt : LinkOutcome::Expired);
    }
}

// Nothing was acknowledged for a round trip and more. Start again at the front with one datagram, and let the
// acknowledgements open the window again; wait longer each time.
void LinkSender::OnResendTimer(LinkTime now)
{
    _probe = true;
    _resendAt = now;
    if (_outbox.SentCount() == 0)
    {
        return;
    }
    GoBackToFront();
    if (_creditLimit >= _cursor)
    {
        // With no credit it is the receiver that is slow, not the path that loses.
        _allowed = FrontDatagram();
        _window.Restore();
        ++_counters.Timeouts;
    }
    _timer.BackOff();
}

void LinkSender::GoBackToFront()
{
    _cursor = _outbox.FirstSequence();
    _bytesInFlight = 0;
}

// How many messages like the first one fit into one datagram: what goes out after the resend timer, old or
// new.
std::size_t LinkSender::FrontDatagram() const
{
    const OutboxMessage &front = _outbox.Sent(_outbox.FirstSequence());
    const std::size_t size = MessageOverhead + front.Bytes + front.Type->size();
    return std::clamp<std::size_t>(_context.Settings.MaxDatagram / size, 1, LinkMaxItems);
}

bool LinkSender::MaySendNext() const
{
    if (_cursor == _outbox.NextSequence() && !_outbox.HasWaiting())
    {
        return false;
    }
    const std::size_t inFlight = static_cast<std::size_t>(_cursor - _outbox.FirstSequence());
    if (inFlight == 0)
    {
        return _probe || _cursor <= _creditLimit;
    }
    return _cursor <= _creditLimit && inFlight < std::min(_options.Window, _allowed) &&
           _window.Fits(_bytesInFlight, AtCursor().Bytes);
}

// The next message to send. There must be one.
const OutboxMessage &LinkSender::AtCursor() const
{
    return _cursor == _outbox.NextSequence() ? _outbox.FirstWaiting() : _outbox.Sent(_cursor);
}

// When to send again what is in flight now. Large payloads get the time that a slow path needs for them; a
// window that has grown shows that the path is not slow.
LinkTime LinkSender::ResendTime(LinkTime now, LinkTime timeout) const
{
    const std::size_t front = _outbox.SentCount() > 0 ? _outbox.Sent(_outbox.FirstSequence()).Bytes : 0;
    const std::size_t bytes = std::min(_bytesInFlight, std::max(_options.WindowBytes, front));
    const auto transfer = std::chrono::duration<double>(static_cast<double>(bytes) /
                                                        static_cast<double>(_context.Settings.SlowPath));
    return now + timeout + std::chrono::duration_cast<LinkTime>(transfer);
}

void LinkSender::SendDatagram(const PeerView &peer, LinkTime now)
{
    LinkData &data = _context.Datagram;
    data.Version = LinkVersion;
    data.Source = _context.Settings.Node;
    data.Destination = _destination;
    data.Queue = _queue;
    data.SenderIncarnation = _ownLife;
    data.ReceiverIncarnation = peer.Incarnation;
    data.Base = _base;
    data.First = _cursor;
    data.Echo = {
        .Clock = peer.Token.Clock, .Time = peer.Token.Time, .HeldFor = (now - peer.Token.CameAt).count()};
    data.SentAt = now.count();
    data.Items.clear();

    const bool fromTheFront = _cursor == _outbox.FirstSequence();
    if (_outbox.SentCount() == 0 && now > _lastSentAt + _timer.PlainTimeout())
    {
        _window.Restore();
    }
    std::size_t bytes = DatagramOverhead + data.Source.size() + data.Destination.size() + data.Queue.size();
    while (data.Items.size() < LinkMaxItems && MaySendNext() && Append(data, bytes, now))
    {
    }
    if (fromTheFront)
    {
        _resendAt = ResendTime(now, _timer.Timeout());
    }
    _lastSentAt = now;
    ++_counters.DatagramsSent;
    _context.Output.Send(data);
    // The payloads are the outbox's: keep none of them.
    data.Items.clear();
}

// Adds the message at the cursor, unless it makes the datagram too large. The first one always goes.
bool LinkSender::Append(LinkData &data, std::size_t &bytes, LinkTime now)
{
    const bool expired = now >= AtCursor().ExpiresAt;
    const std::size_t size = MessageOverhead + (expired ? 0 : AtCursor().Bytes + AtCursor().Type->size());
    if (!data.Items.empty() && bytes + size > _context.Settings.MaxDatagram)
    {
        return false;
    }
    const bool first = _cursor == _outbox.NextSequence();
    if (first)
    {
        _outbox.NumberFirstWaiting();
    }
    OutboxMessage &message = _outbox.Sent(_cursor);
    // Rule S3: a message whose expiry has passed keeps its number and is sent as SKIP, without payload.
    LinkItem &item = data.Items.emplace_back();
    item.Flags = message.Redelivered ? LinkFlagRedelivered : std::uint8_t{0};
    if (expired)
    {
        message.Payload.reset();
        item.Flags = static_cast<std::uint8_t>(item.Flags | LinkFlagSkip);
        item.TtlLeft = 0;
    }
    else
    {
        item.TtlLeft = message.ExpiresAt == LinkNever ? LinkNoExpiry : (message.ExpiresAt - now).count();
        item.Type = *message.Type;
        if (message.Payload)
        {
            item.Payload = message.Payload->View();
            item.Owner = message.Payload;
        }
    }
    ++_counters.MessagesSent;
    _counters.MessagesResent += first ? 0 : 1;
    bytes += size;
    _bytesInFlight += message.Bytes;
    ++_cursor;
    _probe = false;
    return true;
}

bool LinkSender::IsPossible(const LinkAck &ack) const
{
    return ack.SenderIncarnation != _ownLife ||
           (ack.Cumulative >= _base - 1 && ack.Cumulative < _outbox.NextSequence());
}

// Rule S4: everything up to `cum` leaves the outbox with the outcome that its bit says; the credit rises.
void LinkSender::OnAck(const LinkAck &ack, LinkTime now)
{
    if (ack.SenderIncarnation != _ownLife || !IsPossible(ack))
    {
        return;
    }
    if (ack.EchoSentAt > _echoedSentAt && ack.EchoSentAt + ack.EchoHeldFor <= now.count())
    {
        _echoedSentAt = ack.EchoSentAt;
        const LinkTime roundTrip = now - LinkTime(ack.EchoSentAt + ack.EchoHeldFor);
        _timer.Measured(roundTrip);
        _window.Measured(roundTrip);
    }
    const std::uint64_t first = _outbox.FirstSequence();
    if (ack.Cumulative >= first)
    {
        const std::size_t inFlight = _bytesInFlight;
        for (std::uint64_t sequence = first; sequence <= ack.Cumulative; ++sequence)
        {
            const OutboxMessage message = _outbox.TakeSent();
            const std::uint64_t age = ack.Cumulative - sequence;
            if (sequence < _cursor)
            {
                _bytesInFlight -= message.Bytes;
            }
            if (OutcomeHistory::Test(ack.Delivered, age))
            {
                Report(message, LinkOutcome::Delivered);
            }
            else if (message.Redelivered)
            {
                Report(message, LinkOutcome::InDoubt);
            }
            else
            {
                const bool refused = OutcomeHistory::Test(ack.Refused, age);
                Report(message, refused ? LinkOutcome::RefusedThere : LinkOutcome::Expired);
            }
        }
        _window.Acknowledged(inFlight - _bytesInFlight, inFlight);
        _cursor = std::max(_cursor, ack.Cumulative + 1);
        _allowed = std::min(_options.Window, _allowed + static_cast<std::size_t>(ack.Cumulative + 1 - first));
        _resendAt = ResendTime(now, _timer.Timeout());
    }
    if (ack.Time < _creditTime)
    {
        return;  // a newer one came before it
    }
    _creditTime = ack.Time;
    _creditLimit = ack.Cumulative + std::min<std::uint64_t>(ack.Credit, LinkOutcomeBits);
    if (_creditLimit < _outbox.FirstSequence())
    {
        // The receiver has turned away what is on its way: it is sent again when there is credit.
        GoBackToFront();
    }
}

void LinkSender::OnPeerHeard(LinkTime now)
{
    if (_timer.Timeout() >= _context.Settings.HelloPeriod)
    {
        _resendAt = std::min(_resendAt, std::max(now, ResendTime(_lastSentAt, _timer.PlainTimeout())));
    }
}

// Rule S5: what was sent but not acknowledged is in doubt, or is sent again as redelivered; what was never
// sent continues after it. The credit is forgotten.
void LinkSender::Restart()
{
    while (_outbox.SentCount() > 0)
    {
        if (_options.RedeliverInDoubt)
        {
            _outbox.Sent(_outbox.NextSequence() - 1).Redelivered = true;
            _outbox.ReturnLastSent();
        }
        else
        {
            Report(_outbox.TakeSent(), LinkOutcome::InDoubt);
        }
    }
    _base = _outbox.NextSequence();
    _cursor = _base;
    _bytesInFlight = 0;
    _window.Restore();
    _allowed = _options.Window;
    _creditLimit = 0;
    _creditTime = 0;
    _probe = true;
    _timer.Restore();
    ++_counters.Restarts;
}

void LinkSender::Close()
{
    while (_outbox.SentCount() > 0)
    {
        Report(_outbox.TakeSent(), LinkOutcome::InDoubt);
    }
    while (_outbox.HasWaiting())
    {
        const OutboxMessage message = _outbox.TakeWaiting();
        Report(message, message.Redelivered ? LinkOutcome::InDoubt : LinkOutcome::Expired);
    }
    _cursor = _outbox.NextSequence();
}

void LinkSender::Report(const OutboxMessage &message, LinkOutcome outcome)
{
    switch (outcome)
    {
        case LinkOutcome::Delivered:
            ++_counters.Delivered;
            break;
        case LinkOutcome::Expired:
            ++_counters.Expired;
            break;
        case LinkOutcome::InDoubt:
            ++_counters.InDoubt;
            break;
        case LinkOutcome::RefusedThere:
            ++_counters.RefusedThere;
            break;
    }
    _context.Output.OnOutcome(message.Id, _destination, _queue, outcome);
}

LinkSenderCounters LinkSender::Counters() const
{
    LinkSenderCounters counters = _counters;
    counters.Pending = _outbox.Count();
    counters.PendingBytes = _outbox.Bytes();
    counters.Unacknowledged = _outbox.SentCount();
    counters.RoundTrip = _timer.RoundTrip();
    return counters;
}

std::string LinkSender::Describe() const
{
    std::ostringstream out;
    out << "to " << _destination << '/' << _queue << ": base " << _base << " first "
        << _outbox.FirstSequence() << " cursor " << _cursor << " next " << _outbox.NextSequence()
        << " pending " << _outbox.Count() << " bytes " << _outbox.Bytes() << " in flight " << _bytesInFlight
        << " of " << _window.Bytes() << " allowed " << _allowed << " credit to " << _creditLimit << " of "
        << _creditTime << (_probe ? " probe" : "") << " resend at " << _resendAt.count() << " timeout "
        << _timer.Timeout().count() << " echoed " << _echoedSentAt;
    return out.str();
}

}  // namespace Rabit
