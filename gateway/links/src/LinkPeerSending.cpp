// The sending half of LinkPeer: chooses the frames to one other node, and their times.
#include "LinkPeer.h"

#include <rabit/gateway/links/LinkCheck.h>

#include <rabit/gateway/links/LinkFrameCodec.h>

#include <algorithm>
#include <chrono>

namespace Rabit
{

namespace
{

using namespace std::chrono_literals;

// A token held for longer is echoed in a long frame with the whole time: 32 bits of microseconds wrap after
// an hour.
constexpr LinkTime LongestShortHold = 60s;
// Approximate bytes of a frame's head with one acknowledgement.
constexpr std::size_t AboutAnAck = 40;

}  // namespace

// Rule S2: messages go only to a peer that has given a token and is not silent.
bool LinkPeer::IsOpen() const
{
    return _token.Known() && !_silent;
}

void LinkPeer::Advance(LinkTime now)
{
    const bool wasSilent = _silent;
    _silent = IsSilentAt(now);
    _lookAt = now < _lookAt ? _lookAt : LinkNever;
    if (IsUnheardAt(now) && !_droppedBeyondGaps)
    {
        for (const auto &[queue, receiver] : _receivers)
        {
            receiver->DropBeyondGap();
        }
        _droppedBeyondGaps = true;
    }
    for (LinkSender *sender : _byNumber)
    {
        sender->Advance(IsOpen(), now);
    }
    if (_silent && !wasSilent && HasPending())
    {
        HelloSoon(now);
    }
}

void LinkPeer::Run(LinkTime now)
{
    Advance(now);
    // One datagram of each link in turn.
    for (std::size_t idle = 0; IsOpen() && idle < _byNumber.size();)
    {
        LinkSender &sender = *_byNumber[_nextTurn++ % _byNumber.size()];
        idle = SendData(sender, _context.Settings.MaxDatagram, now) ? 0 : idle + 1;
    }
    while (SendUrgent(now))
    {
    }
}

LinkTime LinkPeer::UrgentDue() const
{
    LinkTime due = _unknownLinks.empty() && _refusals.empty() ? _helloAt : LinkTime(0);
    for (const auto &[queue, receiver] : _receivers)
    {
        due = std::min(due, receiver->AckDue());
    }
    return due;
}

std::size_t LinkPeer::UrgentBytes(LinkTime now) const
{
    return UrgentDue() <= now ? AboutAnAck + _context.Settings.AirOverhead : 0;
}

bool LinkPeer::SendUrgent(LinkTime now)
{
    if (now >= _helloAt)
    {
        SendHello(now);
        return true;
    }
    if (UrgentDue() > now)
    {
        return false;
    }
    LinkFrame &frame = BeginFrame(true, now);
    AddAcks(frame, _context.Settings.MaxDatagram, true);
    AcksSent(frame);
    Send(frame, "", false, now);
    return true;
}

std::size_t LinkPeer::DataBytes(const LinkSender &sender, std::size_t most, LinkTime now) const
{
    if (!IsOpen() || !sender.IsReady(now))
    {
        return 0;
    }
    const std::size_t head = AboutAnAck + _context.Settings.AirOverhead;
    return sender.NextBytes(most > head ? most - head : 1) + head;
}

bool LinkPeer::SendData(LinkSender &sender, std::size_t most, LinkTime now)
{
    if (!IsOpen() || !sender.IsReady(now))
    {
        return false;
    }
    LinkFrame &frame = BeginFrame(true, now);
    if (!_context.Output.SendsAcksAlone(_name))
    {
        AddAcks(frame, most / 2, false);
    }
    const LinkSender::Filled filled = sender.Fill(frame, most, now);
    // A part that was cut for a whole datagram leaves no room for them: they go with the next frame.
    if (!frame.Acks.empty() && frame.HasData && frame.Data.Items.front().Payload.size() > most / 4 &&
        LinkFrameCodec::EncodedSize(frame) > most)
    {
        frame.Acks.clear();
    }
    AcksSent(frame);
    const bool hasParts = filled == LinkSender::Filled::Parts;
    if (filled == LinkSender::Filled::Nothing && frame.Acks.empty())
    {
        return false;
    }
    frame.Ask = filled == LinkSender::Filled::Question ||
                (hasParts && (sender.WaitsForAck() || (sender.HasMore() && _path.TakeAsk(now))));
    Send(frame, frame.HasData ? sender.Queue() : "", filled != LinkSender::Filled::Nothing, now);
    // The outbox owns the payloads: keep none of them.
    frame.Data.Items.clear();
    return filled != LinkSender::Filled::Nothing;
}

LinkFrame &LinkPeer::BeginFrame(bool mayBeShort, LinkTime now)
{
    LinkFrame &frame = _context.Frame;
    frame.Version = LinkVersion;
    frame.Source = _context.Settings.Node;
    frame.Destination = _name;
    frame.SenderLife = _ownLife;
    frame.ReceiverLife = _incarnation;
    frame.Clock = _context.Clock;
    frame.Time = now.count();
    frame.Echo = {};
    if (_token.Known())
    {
        frame.Echo = {.Clock = _token.Clock, .Time = _token.Time, .HeldFor = (now - _token.CameAt).count()};
    }
    frame.Short = mayBeShort && _knowsMe && _token.Known() && now - _token.CameAt <= LongestShortHold;
    frame.Check = frame.Short
                      ? LinkCheck::OfShort(_name, _ownLife, _incarnation, frame.Clock, frame.Echo.Clock)
                      : LinkCheck::OfName(_name);
    frame.Ask = false;
    frame.HasData = false;
    frame.Data.Items.clear();
    frame.Acks.clear();
    return frame;
}

void LinkPeer::AddAcks(LinkFrame &frame, std::size_t most, bool one)
{
    _acknowledged.clear();
    std::size_t bytes = LinkFrameCodec::HeaderSize(frame) + 1;
    // Keeps the last acknowledgement of the frame if there is room for it.
    const auto keep = [&frame, &bytes, most, one]
    {
        bytes += LinkFrameCodec::AckSize(frame.Acks.back());
        const bool fits = bytes <= most || (one && frame.Acks.size() == 1);
        if (!fits || frame.Acks.size() > LinkMaxAcks)
        {
            frame.Acks.pop_back();
            return false;
        }
        return true;
    };
    for (const auto &[queue, receiver] : _receivers)
    {
        if (receiver->AckDue() == LinkNever)
        {
            continue;
        }
        receiver->Describe(frame.Acks.emplace_back(), _incarnation);
        if (!keep())
        {
            return;
        }
        _acknowledged.push_back(receiver.get());
    }
    for (const std::uint32_t link : _unknownLinks)
    {
        frame.Acks.emplace_back().Link = link;
        if (!keep())
        {
            return;
        }
    }
    for (const Refusal &refusal : _refusals)
    {
        LinkAck &ack = frame.Acks.emplace_back();
        ack.Link = refusal.Link;
        ack.Open = true;
        ack.Cumulative = refusal.Through;
        ack.Oldest = std::max(
            refusal.Oldest, refusal.Through + 1 - std::min<std::uint64_t>(refusal.Through, LinkWindowParts));
        ack.Refused.fill(~std::uint64_t{0});
        ack.Credit = LinkMaxWindow;
        if (!keep())
        {
            return;
        }
    }
}

void LinkPeer::AcksSent(const LinkFrame &frame)
{
    _acksGoWithData = frame.Acks.empty() ? _acksGoWithData : frame.HasData;
    for (std::size_t i = 0; i < frame.Acks.size(); ++i)
    {
        const LinkAck &ack = frame.Acks[i];
        if (i < _acknowledged.size())
        {
            _acknowledged[i]->Acknowledged(ack);
        }
        else if (ack.Open)
        {
            std::erase_if(_refusals, [&ack](const Refusal &refusal) { return refusal.Link == ack.Link; });
        }
        else
        {
            std::erase(_unknownLinks, ack.Link);
        }
    }
}

void LinkPeer::Send(const LinkFrame &frame, std::string_view queue, bool asks, LinkTime now)
{
    if (asks)
    {
        _unansweredSince = std::min(_unansweredSince, now);
        _askedAt = AsEchoed(now);
        _askedSince = std::min(_askedSince, _askedAt);
    }
    _context.Output.Send(frame, queue);
}

// Hellos to a peer that does not know this node's incarnation, or is away, become more and more seldom.
void LinkPeer::SendHello(LinkTime now)
{
    LinkFrame &frame = BeginFrame(false, now);
    AddAcks(frame, _context.Settings.MaxDatagram, false);
    AcksSent(frame);
    const bool wanted = !IsOpen() && HasPending();
    frame.Ask = wanted;
    _lastHelloAt = now;
    _helloGap.Next();
    const LinkTime step = _silent ? _context.Settings.SilentHelloPeriod : _helloGap.Interval();
    _helloAt = wanted ? now + step : LinkNever;
    Send(frame, "", wanted, now);
}

LinkTime LinkPeer::NextDue() const
{
    LinkTime due = std::min(UrgentDue(), _lookAt);
    for (const LinkSender *sender : _byNumber)
    {
        due = std::min(due, sender->NextDue(IsOpen()));
    }
    if (!_droppedBeyondGaps && std::any_of(_receivers.begin(), _receivers.end(),
                                           [](const auto &entry) { return entry.second->KeepsParts(); }))
    {
        due = std::min(due, _heardAt + _context.Settings.SilentAfter);
    }
    return due;
}

}  // namespace Rabit
