#include "LinkSender.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace Rabit
{

namespace
{

// After this many bytes of unanswered probes the next probes are smaller: others need the air.
constexpr std::size_t BytesInVain = 2'000;
// After more unanswered probes than this a path that starts holds up no other one.
constexpr int LongEnoughForStart = 2;

}  // namespace

LinkSender::LinkSender(LinkContext &context, PathControl &path, std::uint32_t number, std::string destination,
                       std::string queue, const LinkOptions &options)
    : _context(context),
      _path(path),
      _number(number),
      _destination(std::move(destination)),
      _queue(std::move(queue)),
      _options(options),
      _outbox(_options)
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
        _probeAt = std::max(now, _lastSentAt + _path.ProbeTimeout());
    }
    else if (_doublings > 0 && _probesInVain < PathControl::ProbesInVain &&
             now >= _lastSentAt + _path.ProbeTimeout())
    {
        _probe = true;  // something new need not wait for a timer that has backed off
    }
    const LinkTime expiresAt = _options.Expire > LinkTime(0) ? now + _options.Expire : LinkNever;
    _outbox.Add({.Id = id,
                 .ExpiresAt = expiresAt,
                 .Type = &type,
                 .TypeNumber = _types.NumberOf(type),
                 .Payload = std::move(payload),
                 .Bytes = bytes});
    ++_counters.Accepted;
    return LinkRefusal::None;
}

void LinkSender::Advance(bool open, LinkTime now)
{
    ExpireWaiting(now);
    ExpireSent(now);
    if (!open)
    {
        SettleExpired(now);
        return;
    }
    if (_outbox.Empty())
    {
        return;
    }
    if (now >= _lostAt)
    {
        FindLost(_lastEcho, now);
    }
    if (now >= _probeAt)
    {
        OnProbeTimer();
    }
}

// A message that expires before any part of it was sent needs no acknowledgement. All messages of a link live
// equally long, so the oldest is the first to expire.
void LinkSender::ExpireWaiting(LinkTime now)
{
    while (_outbox.HasWaiting() && now >= _outbox.FirstWaiting().ExpiresAt)
    {
        ReportExpired(_outbox.TakeWaiting());
    }
}

// Rule S3: of a message that expires half sent only a SKIP is still sent.
void LinkSender::ExpireSent(LinkTime now)
{
    if (!_outbox.IsInPart() || now < _outbox.Next().ExpiresAt)
    {
        return;
    }
    SentPart &end = _outbox.Part(_outbox.CutSkip());
    OutboxMessage &message = _outbox.MessageOf(end);
    message.IsSkipped = true;
    message.Payload.reset();
    end.IsLost = true;
    ++_lost;
}

// Rule S7: an answer may never come. A message that was sent as a whole may have arrived.
void LinkSender::SettleExpired(LinkTime now)
{
    for (OutboxMessage *first = _outbox.FirstUnsettled(); first != nullptr && now >= first->ExpiresAt;
         first = _outbox.FirstUnsettled())
    {
        const bool mayHaveArrived = first->MayArrive;
        _outbox.Settle(*first);
        if (mayHaveArrived)
        {
            Report(*first, LinkOutcome::InDoubt);
        }
        else
        {
            ReportExpired(*first);
        }
    }
}

// Nothing was acknowledged for a round trip and more: ask again with one datagram (the tail loss probe of RFC
// 8985), later and later. The answer will show which parts are lost: a path that has only become slow must
// not get everything once more.
void LinkSender::OnProbeTimer()
{
    _probe = true;
    _probeAt = LinkNever;  // until the probe is sent
    if (_outbox.SentCount() == 0)
    {
        return;
    }
    if (IsTurnedAway())
    {
        ++_stalls;
    }
    else
    {
        _doublings = std::max(_doublings + 1, std::min(_probesInVain, PathControl::ProbesInVain));
        if (_doublings > LongEnoughForStart)
        {
            _path.LeaveStart();
        }
    }
}

// Without any acknowledgement there is no credit either, but then something was lost.
bool LinkSender::IsTurnedAway() const
{
    return _isKnown && _outbox.SentCount() > 0 && (_outbox.FirstMessage() >= _creditLimit || IsFirstHeld());
}

bool LinkSender::IsFirstHeld() const
{
    const std::uint64_t first = _outbox.FirstSequence();
    return first < _outbox.NextSequence() && _outbox.Part(first).IsHeld;
}

void LinkSender::ArmProbe(bool turnedAway, LinkTime now)
{
    if (_outbox.Empty())
    {
        _probeAt = LinkNever;
        return;
    }
    const LinkTime plain = _path.ProbeTimeout(_doublings);
    // The receiver of a full queue announces room itself: asking only covers the loss of that, even more so
    // if the receiver has the message already.
    const int stalls = _stalls + (IsFirstHeld() ? 2 : 0);
    const LinkTime slow = std::min<LinkTime>(plain * (1LL << std::min(stalls, 8)),
                                             std::max(plain, _context.Settings.MaxResend));
    _probeAt = now + (turnedAway ? slow : plain);
}

bool LinkSender::HasCredit(std::uint64_t message) const
{
    return message < _creditLimit || (_probe && message == _outbox.FirstMessage());
}

bool LinkSender::HasLost() const
{
    if (_lost == 0)
    {
        return false;
    }
    std::uint64_t sequence = _outbox.FirstSequence();
    while (!_outbox.Part(sequence).IsLost)
    {
        ++sequence;
    }
    return HasCredit(_outbox.Part(sequence).Message);
}

bool LinkSender::MayCut() const
{
    return _outbox.HasMore() && _outbox.NextSequence() - _outbox.FirstSequence() < LinkWindowParts - 1 &&
           (_outbox.IsInPart() || _outbox.SentCount() < _options.Window) && HasCredit(_outbox.NextIs());
}

// When a datagram may be sent: at once, at the time of the path's pacing, or never.
LinkTime LinkSender::ReadyAt() const
{
    if (_outbox.Empty())
    {
        return LinkNever;
    }
    if (_probe)
    {
        return LinkTime(0);
    }
    if (_doublings >= 2 || !(HasLost() || MayCut()))
    {
        return LinkNever;
    }
    // A floor: one datagram of each link may always be under way.
    if (_inFlight == 0)
    {
        return LinkTime(0);
    }
    return _path.HasRoom() ? _path.PacedUntil() : LinkNever;
}

LinkTime LinkSender::NextDue(bool open) const
{
    if (_outbox.Empty())
    {
        return LinkNever;
    }
    const LinkTime due = _outbox.HasMore() ? _outbox.Next().ExpiresAt : LinkNever;
    if (open)
    {
        return std::min({due, ReadyAt(), _probeAt, _lostAt});
    }
    const OutboxMessage *first = _outbox.FirstUnsettled();
    return first == nullptr ? due : std::min(due, first->ExpiresAt);
}

void LinkSender::OnPeerHeard(LinkTime now)
{
    if (_doublings > 0 && !IsTurnedAway())
    {
        _probeAt = std::min(_probeAt, std::max(now, _lastSentAt + _path.ProbeTimeout()));
    }
}

void LinkSender::ProbeNow(LinkTime now)
{
    _doublings = 0;
    _bytesInVain = 0;
    _probesInVain = 0;
    _probeAt = _probeAt == LinkNever ? LinkNever : now;
}

bool LinkSender::IsInVain() const
{
    return _bytesInVain >= BytesInVain;
}

void LinkSender::OnEcho(LinkTime echo)
{
    if (IsInVain() && echo > _inVainSince)
    {
        // There is a path. Probes with parts were unanswered on it all the same: large ones may not get
        // through.
        _bytesInVain = 0;
        _probesInVain = _partsInVain;
        _doublings = std::min(_doublings, _partsInVain);
        _probe = true;
    }
}

// Rule S5: a message that was sent whole and not acknowledged is in doubt, or is sent again as redelivered.
// Messages that were sent in part or not at all follow, from their beginning. The credit is forgotten.
void LinkSender::Restart()
{
    for (std::uint64_t left = _outbox.NextSequence() - _outbox.FirstSequence(); left > 0; --left)
    {
        SentPart part = _outbox.TakePart();
        LeavePath(part);
    }
    while (_outbox.SentCount() > 0 && _outbox.Message(_outbox.FirstMessage()).IsSettled)
    {
        _outbox.TakeSent();
    }
    while (_outbox.SentCount() > 0 && !_options.RedeliverInDoubt)
    {
        const OutboxMessage &oldest = _outbox.Message(_outbox.FirstMessage());
        if (oldest.MayArrive)
        {
            Report(_outbox.TakeSent(), LinkOutcome::InDoubt);
        }
        else if (oldest.IsSkipped)
        {
            ReportExpired(_outbox.TakeSent());
        }
        else
        {
            _outbox.ReturnLastSent();  // only the newest one can be there in part
        }
    }
    while (_outbox.SentCount() > 0)
    {
        OutboxMessage &newest = _outbox.Message(_outbox.NextMessage() - 1);
        newest.Redelivered = newest.Redelivered || newest.MayArrive;
        _outbox.ReturnLastSent();
    }
    _base = _outbox.NextSequence();
    _types.ForgetKnown();
    _isKnown = false;
    _lost = 0;
    _held = 0;
    _creditLimit = 0;
    _ackTime = 0;
    _probe = true;
    _doublings = 0;
    _probesInVain = 0;
    _partsInVain = 0;
    _bytesInVain = 0;
    _stalls = 0;
    _probeAt = LinkNever;
    _lostAt = LinkNever;
    ++_counters.Restarts;
}

void LinkSender::Close()
{
    for (std::uint64_t left = _outbox.NextSequence() - _outbox.FirstSequence(); left > 0; --left)
    {
        SentPart part = _outbox.TakePart();
        LeavePath(part);
    }
    while (_outbox.SentCount() > 0)
    {
        const OutboxMessage message = _outbox.TakeSent();
        if (message.IsSettled)
        {
            continue;
        }
        if (message.MayArrive)
        {
            Report(message, LinkOutcome::InDoubt);
        }
        else
        {
            ReportExpired(message);
        }
    }
    while (_outbox.HasWaiting())
    {
        ReportExpired(_outbox.TakeWaiting());
    }
    _lost = 0;
    _held = 0;
}

void LinkSender::ReportExpired(const OutboxMessage &message)
{
    Report(message, message.Redelivered ? LinkOutcome::InDoubt : LinkOutcome::Expired);
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
            _context.Output.OnRefusedThere(_destination, _queue, *message.Type);
            break;
    }
    _context.Output.OnOutcome(message.Id, _destination, _queue, outcome);
}

LinkSenderCounters LinkSender::Counters() const
{
    LinkSenderCounters counters = _counters;
    counters.Pending = _outbox.Count();
    counters.PendingBytes = _outbox.Bytes();
    counters.Fill = _outbox.Fill();
    counters.Unacknowledged = _outbox.UnsettledCount();
    counters.UnacknowledgedParts = static_cast<std::size_t>(_outbox.NextSequence() - _outbox.FirstSequence());
    counters.HeldBack = IsTurnedAway();
    counters.RoundTrip = _path.Times().Smoothed();
    return counters;
}

std::string LinkSender::Describe() const
{
    std::ostringstream out;
    out << "to " << _destination << '/' << _queue << ": link " << _number << (_isKnown ? " known" : "")
        << " base " << _base << " first " << _outbox.FirstSequence() << " next " << _outbox.NextSequence()
        << " messages " << _outbox.FirstMessage() << " to " << _outbox.NextMessage() << " pending "
        << _outbox.Count() << " bytes " << _outbox.Bytes() << " in flight " << _inFlight << " lost " << _lost
        << " held " << _held << " credit to " << _creditLimit << " of " << _ackTime
        << (_probe ? " probe" : "") << " probe at " << _probeAt.count() << " doublings " << _doublings
        << " in vain " << _probesInVain << ' ' << _partsInVain << ' ' << _bytesInVain << " since "
        << _inVainSince.count() << " lost at " << _lostAt.count() << " echo " << _lastEcho.count();
    return out.str();
}

}  // namespace Rabit
