// Rule S2: fills a datagram.
#include "LinkSender.h"

#include <rabit/gateway/links/LinkFrameCodec.h>

#include <algorithm>

namespace Rabit
{

namespace
{

// A piece of a message is put into a datagram only if at least this much room is left.
constexpr std::size_t SmallestPiece = 128;
// If the loss rate exceeds LossThatCalls, small unacknowledged parts are sent once more in datagrams that are
// sent anyway: parts up to SmallPart bytes, in up to this share of the datagram.
constexpr double LossThatCalls = 0.02;
constexpr std::size_t SmallPart = 256;
constexpr std::size_t PartOfDatagram = 4;
// Most bytes of parts in a probe after others were unanswered.
constexpr std::size_t SmallProbe = 128;
// Approximate bytes before a message in a datagram, without names.
constexpr std::size_t AboutAnItem = 12;
constexpr std::size_t AboutNames = 64;
// The payload's length may take one byte more than that of an empty one, twice.
constexpr std::size_t LengthBytes = 2;

}  // namespace

struct LinkSender::Filling
{
    LinkFrame &Frame;
    std::size_t Most;
    LinkTime Now;
    LinkTime SentAt;
    std::size_t Head = 0;   // bytes before the parts
    std::size_t Used = 0;   // bytes of the parts
    std::size_t Along = 0;  // those of parts that go along once more

    LinkData &Data() { return Frame.Data; }
    bool IsFull() const { return Frame.Data.Items.size() >= LinkMaxItems; }
    bool Fits(std::size_t bytes) const
    {
        return !IsFull() && (Frame.Data.Items.empty() || Head + Used + bytes <= Most);
    }
    std::size_t Room() const { return Most > Head + Used ? Most - Head - Used : 0; }
};

bool LinkSender::IsReady(LinkTime now) const
{
    return ReadyAt() <= now;
}

std::size_t LinkSender::NextBytes(std::size_t most) const
{
    most = std::min(most, _probe && IsInVain() ? SmallProbe : _context.Settings.MaxDatagram);
    std::size_t bytes = 0;
    std::size_t least = 1;
    if (_lost > 0 || (_probe && !IsInVain()))
    {
        for (std::uint64_t sequence = _outbox.FirstSequence();
             sequence < _outbox.NextSequence() && bytes < most; ++sequence)
        {
            const SentPart &part = _outbox.Part(sequence);
            const bool goes = part.IsLost || (_probe && !part.IsHeld);
            least = goes && bytes == 0 ? part.Length + LengthBytes : least;
            bytes += goes ? part.Length + LengthBytes : 0;
        }
    }
    if (bytes < most && MayCut())
    {
        bytes += _outbox.BytesToCut(most - bytes, AboutAnItem);
    }
    if (_path.LossRate() > LossThatCalls)
    {
        bytes += std::min(_inFlight, most / PartOfDatagram);
    }
    // At the beginning of a link the queue, the types and both lives are named.
    bytes += _isKnown ? 0 : _queue.size() + AboutNames;
    return std::clamp(bytes, least, std::max(most, least));
}

LinkSender::Filled LinkSender::Fill(LinkFrame &frame, std::size_t most, LinkTime now)
{
    ExpireWaiting(now);
    ExpireSent(now);
    LinkData &data = frame.Data;
    data.Link = _number;
    data.Queue = _isKnown ? std::string_view() : std::string_view(_queue);
    data.Oldest = _outbox.FirstSequence();
    data.Items.clear();
    Filling filling{.Frame = frame, .Most = most, .Now = now, .SentAt = AsEchoed(now)};
    filling.Head =
        LinkFrameCodec::HeaderSize(frame) + LinkFrameCodec::DataSize(data) + (frame.Acks.empty() ? 0 : 1);
    for (const LinkAck &ack : frame.Acks)
    {
        filling.Head += LinkFrameCodec::AckSize(ack);
    }
    const bool turnedAway = IsTurnedAway();
    if (_probe && IsInVain())
    {
        if (!IsProbeSmall(now))
        {
            data.Items.clear();
            OnSent(filling.Head, false, turnedAway, now);
            return Filled::Question;
        }
        filling.Most = std::min(most, filling.Head + SmallProbe);
    }
    FillAgain(filling);
    while (FillNew(filling))
    {
    }
    if (data.Items.empty())
    {
        if (_probe && _outbox.FirstSequence() < _outbox.NextSequence())
        {
            // The receiver has every part: the first one is sent again to ask it to consume them.
            std::uint64_t first = _outbox.FirstSequence();
            _outbox.Part(first).IsHeld = false;
            --_held;
            Again(filling, first);
        }
        else
        {
            _probe = false;
            return Filled::Nothing;
        }
    }
    frame.HasData = true;
    OnSent(filling.Head + filling.Used, true, turnedAway, now);
    return Filled::Parts;
}

// A datagram of `bytes` bytes is complete.
void LinkSender::OnSent(std::size_t bytes, bool hasParts, bool turnedAway, LinkTime now)
{
    const std::size_t onAir = bytes + _context.Settings.AirOverhead;
    if (_probe && _doublings > 0)
    {
        const bool wasInVain = IsInVain();
        ++_probesInVain;
        _partsInVain += hasParts ? 1 : 0;
        _bytesInVain += onAir;
        _inVainSince = IsInVain() && !wasInVain ? now : _inVainSince;
    }
    _probe = false;
    _lastSentAt = now;
    _counters.BytesSent += onAir;
    ArmProbe(turnedAway, now);
}

// True if the part that a probe would begin with fits a small probe.
bool LinkSender::IsProbeSmall(LinkTime now) const
{
    std::uint64_t sequence = _outbox.FirstSequence();
    while (sequence < _outbox.NextSequence() && _outbox.Part(sequence).IsHeld)
    {
        ++sequence;
    }
    if (sequence == _outbox.NextSequence())
    {
        sequence = _outbox.FirstSequence();  // the receiver has every part, and is asked to consume them
    }
    if (sequence == _outbox.NextSequence())
    {
        return true;
    }
    const SentPart &part = _outbox.Part(sequence);
    const OutboxMessage &message = _outbox.MessageOf(part);
    return part.Length <= SmallProbe || message.IsSkipped || now >= message.ExpiresAt;
}

// Adds lost parts (all unacknowledged parts, if this is a probe), and parts that go along once more.
void LinkSender::FillAgain(Filling &filling)
{
    const bool along = _path.LossRate() > LossThatCalls && !_probe;
    if (_lost == 0 && !_probe && !along)
    {
        return;
    }
    const LinkTime half = _path.Times().Smoothed() / 2;
    const std::size_t forNext = along ? BytesForNext(filling) : 0;
    for (std::uint64_t sequence = _outbox.FirstSequence(); sequence < _outbox.NextSequence();)
    {
        const SentPart &part = _outbox.Part(sequence);
        if (!HasCredit(part.Message))
        {
            return;
        }
        const bool extra = along && !part.IsLost && part.Cost > 0 && part.Length <= SmallPart &&
                           part.SentAt + half <= filling.Now &&
                           filling.Along + part.Length <= filling.Most / PartOfDatagram &&
                           BytesAgain(filling, sequence) + forNext <= filling.Room();
        if (part.IsHeld || !(part.IsLost || _probe || extra))
        {
            ++sequence;
            continue;
        }
        filling.Along += extra ? part.Length : 0;
        if (!Again(filling, sequence))
        {
            return;
        }
    }
}

std::size_t LinkSender::BytesAgain(const Filling &filling, std::uint64_t sequence) const
{
    const SentPart &part = _outbox.Part(sequence);
    LinkItem item;
    Describe(part, _outbox.MessageOf(part), sequence, item, filling.Now);
    return LinkFrameCodec::ItemSize(item) + item.Payload.size();
}

// Least bytes of the next new part. They are kept free of parts that go along once more, which would
// otherwise keep new parts out for ever.
std::size_t LinkSender::BytesForNext(const Filling &filling) const
{
    if (!MayCut())
    {
        return 0;
    }
    const OutboxMessage &next = _outbox.Next();
    const std::size_t left = next.Bytes - next.Cut;
    LinkItem item;
    Describe({.Offset = next.Cut, .Length = left}, next, _outbox.NextSequence(), item, filling.Now);
    const bool isCut = next.Cut > 0 || left > filling.Most / 2;
    return LinkFrameCodec::ItemSize(item) + LengthBytes + (isCut ? std::min(left, SmallestPiece) : left);
}

// Adds a part that was sent before, and moves on to the next. False: there is no room for it.
bool LinkSender::Again(Filling &filling, std::uint64_t &sequence)
{
    SentPart &part = _outbox.Part(sequence);
    OutboxMessage &message = _outbox.MessageOf(part);
    if (!message.IsSkipped && filling.Now >= message.ExpiresAt)
    {
        message.IsSkipped = true;
        message.Payload.reset();
    }
    LinkItem item;
    Describe(part, message, sequence, item, filling.Now);
    const std::size_t bytes = LinkFrameCodec::ItemSize(item) + item.Payload.size();
    if (!filling.Fits(bytes))
    {
        return false;
    }
    // Rule S3: a message whose expiry has passed keeps its numbers, which are sent as one SKIP.
    for (; sequence < item.Through; ++sequence)
    {
        SentPart &covered = _outbox.Part(sequence + 1);
        LeavePath(covered);
        covered.SentAt = filling.SentAt;
        _lost -= covered.IsLost ? 1 : 0;
        covered.IsLost = false;
    }
    ++sequence;
    part.IsAgain = true;
    part.IsNamed = part.IsNamed || !item.Type.empty();
    filling.Data().Items.push_back(std::move(item));
    OnPartSent(filling, part, bytes);
    ++_counters.PartsResent;
    return true;
}

void LinkSender::Describe(const SentPart &part, const OutboxMessage &message, std::uint64_t sequence,
                          LinkItem &item, LinkTime now) const
{
    item.Sequence = sequence;
    item.Through = sequence;
    item.Flags = message.Redelivered ? LinkFlagRedelivered : std::uint8_t{0};
    if (message.IsSkipped)
    {
        item.Flags = static_cast<std::uint8_t>(item.Flags | LinkFlagSkip);
        item.Through = message.End - 1;
        return;
    }
    if (part.Offset == 0)
    {
        item.Flags = static_cast<std::uint8_t>(item.Flags | LinkFlagFirst);
        item.TypeNumber = message.TypeNumber;
        item.Type = _types.IsKnown(message.TypeNumber) ? std::string_view() : std::string_view(*message.Type);
        item.Size = message.Bytes;
    }
    if (part.Offset + part.Length == message.Bytes)
    {
        item.Flags = static_cast<std::uint8_t>(item.Flags | LinkFlagLast);
        item.TtlLeft = message.ExpiresAt == LinkNever ? LinkNoExpiry : (message.ExpiresAt - now).count();
    }
    if (message.Payload)
    {
        item.Payload = message.Payload->View().subspan(part.Offset, part.Length);
        item.Owner = message.Payload;
    }
}

// Adds as much of the next message as fits: its whole rest, or a piece. False: nothing more fits or may be
// sent.
bool LinkSender::FillNew(Filling &filling)
{
    if (!MayCut() || filling.IsFull())
    {
        return false;
    }
    const OutboxMessage &next = _outbox.Next();
    const std::size_t left = next.Bytes - next.Cut;
    LinkItem item;
    Describe({.Offset = next.Cut, .Length = left}, next, _outbox.NextSequence(), item, filling.Now);
    std::size_t head = LinkFrameCodec::ItemSize(item) + LengthBytes;
    std::size_t length = left;
    if (filling.Head + filling.Used + head + left > filling.Most)
    {
        // A message that fits a datagram of its own waits for that; a larger one is cut.
        const bool empty = filling.Data().Items.empty();
        const std::size_t room = filling.Room() > head ? filling.Room() - head : 0;
        if (!empty && (room < SmallestPiece || (next.Cut == 0 && left <= filling.Most / 2)))
        {
            return false;
        }
        length = std::min(left, std::max(room, SmallestPiece));
        item = {};
        Describe({.Offset = next.Cut, .Length = length}, next, _outbox.NextSequence(), item, filling.Now);
    }
    SentPart &part = _outbox.Part(_outbox.Cut(length));
    part.IsNamed = !item.Type.empty();
    head = LinkFrameCodec::ItemSize(item);
    filling.Data().Items.push_back(std::move(item));
    OnPartSent(filling, part, head + length);
    return true;
}

void LinkSender::OnPartSent(Filling &filling, SentPart &part, std::size_t bytes)
{
    if (part.Cost > 0)
    {
        LeavePath(part);
    }
    _lost -= part.IsLost ? 1 : 0;
    part.IsLost = false;
    part.SentAt = filling.SentAt;
    const bool first = filling.Data().Items.size() == 1;
    part.Cost = bytes + (first ? filling.Head + _context.Settings.AirOverhead : 0);
    filling.Used += bytes;
    _inFlight += part.Cost;
    _path.Sent(part.Cost, filling.Now);
}

void LinkSender::LeavePath(SentPart &part)
{
    _path.Forget(part.Cost);
    _inFlight -= part.Cost;
    part.Cost = 0;
}

}  // namespace Rabit
