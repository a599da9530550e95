// Rule S4: processes acknowledgements.
#include "LinkSender.h"

#include "OutcomeHistory.h"

#include <algorithm>

namespace Rabit
{

namespace
{

bool IsHeldIn(const LinkAck &ack, std::uint64_t sequence)
{
    const std::uint64_t bit = sequence - ack.Cumulative - 1;
    return bit < LinkWindowParts && ((ack.Held[bit / 64] >> (bit % 64)) & 1) != 0;
}

// The highest number in the acknowledgement.
std::uint64_t HighestIn(const LinkAck &ack)
{
    for (std::size_t word = ack.Held.size(); word-- > 0;)
    {
        if (ack.Held[word] != 0)
        {
            std::uint64_t bit = 63;
            while (((ack.Held[word] >> bit) & 1) == 0)
            {
                --bit;
            }
            return ack.Cumulative + 1 + word * 64 + bit;
        }
    }
    return ack.Cumulative;
}

}  // namespace

bool LinkSender::IsPossible(const LinkAck &ack) const
{
    if (!ack.Open)
    {
        return true;
    }
    const bool told = ack.Cumulative < _outbox.FirstSequence() || ack.Oldest <= _outbox.FirstSequence();
    return ack.Cumulative >= _base - 1 && HighestIn(ack) < _outbox.NextSequence() && told;
}

void LinkSender::OnAck(const LinkAck &ack, std::int64_t time, LinkTime echo, LinkTime now)
{
    if (!ack.Open)
    {
        // There is no session yet. Names that the receiver does not know are sent again.
        _isKnown = _isKnown && time < _ackTime;
        return;
    }
    _isKnown = true;
    const std::uint64_t first = _outbox.FirstSequence();
    const bool wasHeld = IsFirstHeld();
    TakeUpTo(ack, now);
    const bool progress = _outbox.FirstSequence() != first;
    if (time >= _ackTime)
    {
        _ackTime = time;
        TakeHeld(ack, now);
        _creditLimit = _outbox.FirstMessage() + std::min<std::uint64_t>(ack.Credit, LinkMaxWindow);
        FindLost(echo, now);
        _doublings = 0;
        _probesInVain = 0;
        _partsInVain = 0;
        _bytesInVain = 0;
    }
    const bool turnedAway = IsTurnedAway();
    _stalls = progress || !turnedAway ? 0 : _stalls;
    if (progress || (_doublings == 0 && !turnedAway) || (IsFirstHeld() && !wasHeld))
    {
        ArmProbe(turnedAway, now);
    }
}

// Everything up to `cum` leaves the outbox, each message with the outcome in the bit of its last part.
void LinkSender::TakeUpTo(const LinkAck &ack, LinkTime now)
{
    while (_outbox.FirstSequence() < _outbox.NextSequence() && _outbox.FirstSequence() <= ack.Cumulative)
    {
        const std::uint64_t sequence = _outbox.FirstSequence();
        SentPart &part = _outbox.Part(sequence);
        OnArrived(part, now);
        _held -= part.IsHeld ? 1 : 0;
        _outbox.TakePart();
        const OutboxMessage &oldest = _outbox.Message(_outbox.FirstMessage());
        if (!oldest.IsWhole || sequence + 1 != oldest.End)
        {
            continue;
        }
        const OutboxMessage message = _outbox.TakeSent();
        if (message.IsSettled)
        {
            continue;
        }
        if (OutcomeHistory::Test(ack.Delivered, sequence))
        {
            Report(message, LinkOutcome::Delivered);
        }
        else if (message.Redelivered)
        {
            Report(message, LinkOutcome::InDoubt);
        }
        else
        {
            const bool refused = OutcomeHistory::Test(ack.Refused, sequence);
            Report(message, refused ? LinkOutcome::RefusedThere : LinkOutcome::Expired);
        }
    }
}

// Parts that the receiver holds beyond a gap need not be sent again, unless a later acknowledgement shows
// that it dropped them.
void LinkSender::TakeHeld(const LinkAck &ack, LinkTime now)
{
    if (_held == 0 && HighestIn(ack) == ack.Cumulative)
    {
        return;
    }
    for (std::uint64_t sequence = _outbox.FirstSequence(); sequence < _outbox.NextSequence(); ++sequence)
    {
        SentPart &part = _outbox.Part(sequence);
        const bool held = IsHeldIn(ack, sequence);
        if (held && !part.IsHeld)
        {
            part.IsHeld = true;
            ++_held;
            OnArrived(part, now);
        }
        else if (!held && part.IsHeld)
        {
            part.IsHeld = false;
            --_held;
            SetLost(part, false);
        }
    }
}

void LinkSender::OnArrived(SentPart &part, LinkTime now)
{
    if (part.Cost > 0)
    {
        _path.Acknowledged(part.Cost, now);
        _inFlight -= part.Cost;
        part.Cost = 0;
    }
    _lost -= part.IsLost ? 1 : 0;
    part.IsLost = false;
    const OutboxMessage &message = _outbox.MessageOf(part);
    if (part.IsNamed && !message.IsSkipped)
    {
        _types.SetKnown(message.TypeNumber);
    }
}

// RACK (RFC 8985): a part is lost if it was sent before one that has arrived, and a round trip and some time
// for reordering ago.
void LinkSender::FindLost(LinkTime echo, LinkTime now)
{
    _lastEcho = std::max(_lastEcho, echo);
    _lostAt = LinkNever;
    if (_outbox.FirstSequence() == _outbox.NextSequence())
    {
        return;
    }
    const LinkTime patience =
        std::max(_path.Times().Latest(), _path.Times().Smoothed()) + _path.ReorderingTime();
    for (std::uint64_t sequence = _outbox.FirstSequence(); sequence < _outbox.NextSequence(); ++sequence)
    {
        SentPart &part = _outbox.Part(sequence);
        if (part.SentAt > _lastEcho && !part.IsAgain)
        {
            return;  // all parts after it were sent later, too
        }
        if (part.Cost == 0 || part.SentAt > _lastEcho)
        {
            continue;
        }
        if (part.SentAt + patience <= now)
        {
            SetLost(part, HasCredit(part.Message));
        }
        else
        {
            _lostAt = std::min(_lostAt, part.SentAt + patience);
        }
    }
}

void LinkSender::SetLost(SentPart &part, bool onTheWay)
{
    if (onTheWay)
    {
        _path.Lost(part.Cost);
    }
    else
    {
        _path.Forget(part.Cost);
    }
    _inFlight -= part.Cost;
    part.Cost = 0;
    _lost += part.IsLost ? 0 : 1;
    part.IsLost = true;
}

}  // namespace Rabit
