// What goes out to one other node, and when.
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

// A token that was held for longer is echoed with the whole time: 32 bits of microseconds are an hour.
constexpr LinkTime LongestShortHold = 60s;
// Of a frame's head, with an acknowledgement.
constexpr std::size_t AboutAnAck = 40;

}  // namespace

// Rule S2: messages go to who has given a token, and answers.
bool LinkPeer::IsOpen() const
{
    return _token.Known() && !_silent;
}

void LinkPeer::Advance(LinkTime now)
{
    const bool wasSilent = _silent;
    _silent = IsSilentAt(now);
    for (const auto &[queue, receiver] : _receivers)
    {
        receiver->Advance(now);
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
        idle = sender.IsReady(now) && SendData(sender, _context.Settings.MaxDatagram, now) ? 0 : idle + 1;
    }
    while (SendUrgent(now))
    {
    }
}

LinkTime LinkPeer::UrgentDue() const
{
    LinkTime due = _unknownLinks.empty() ? _helloAt : LinkTime(0);
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
    AddAcks(frame);
    Send(frame, false, now);
    return true;
}

std::size_t LinkPeer::DataBytes(const LinkSender &sender, LinkTime now) const
{
    return IsOpen() && sender.IsReady(now) ? sender.NextBytes() + AboutAnAck + _context.Settings.AirOverhead
                                           : 0;
}

bool LinkPeer::SendData(LinkSender &sender, std::size_t most, LinkTime now)
{
    if (!IsOpen() || !sender.IsReady(now))
    {
        return false;
    }
    LinkFrame &frame = BeginFrame(true, now);
    AddAcks(frame);
    const LinkSender::Filled filled = sender.Fill(frame, most, now);
    const bool hasParts = filled == LinkSender::Filled::Parts;
    if (filled == LinkSender::Filled::Nothing && frame.Acks.empty())
    {
        return false;
    }
    frame.Ask = filled == LinkSender::Filled::Question ||
                (hasParts && (sender.WaitsForAck() || (sender.HasMore() && _path.TakeAsk(now))));
    Send(frame, filled != LinkSender::Filled::Nothing, now);
    // The payloads are the outbox's: keep none of them.
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

// All acknowledgements that are waiting, due or not: they cost little in a frame that goes anyway.
void LinkPeer::AddAcks(LinkFrame &frame)
{
    for (const auto &[queue, receiver] : _receivers)
    {
        if (receiver->AckDue() != LinkNever && frame.Acks.size() < LinkMaxAcks)
        {
            receiver->Acknowledge(frame.Acks.emplace_back(), _incarnation);
        }
    }
    while (!_unknownLinks.empty() && frame.Acks.size() < LinkMaxAcks)
    {
        frame.Acks.emplace_back().Link = _unknownLinks.back();
        _unknownLinks.pop_back();
    }
}

void LinkPeer::Send(const LinkFrame &frame, bool asks, LinkTime now)
{
    if (asks && _unansweredSince == LinkNever)
    {
        _unansweredSince = now;
    }
    _context.Output.Send(frame);
}

void LinkPeer::SendHello(LinkTime now)
{
    LinkFrame &frame = BeginFrame(false, now);
    AddAcks(frame);
    const bool wanted = !IsOpen() && HasPending();
    frame.Ask = wanted;
    _lastHelloAt = now;
    _helloAt = wanted ? now + NextHelloStep() : LinkNever;
    ++_context.Counters.HellosSent;
    Send(frame, wanted, now);
}

// The first hello often comes before the network has matched the two nodes, and is lost.
LinkTime LinkPeer::NextHelloStep()
{
    if (_silent)
    {
        return _context.Settings.SilentHelloPeriod;
    }
    const LinkTime period = _context.Settings.HelloPeriod;
    const LinkTime first = 2 * _context.Settings.HelloGap;
    const bool begins = _token.Known() || _unansweredSince == LinkNever;
    const LinkTime step = begins ? first : std::min(std::max(_helloStep, first), period);
    _helloStep = 2 * step;
    return step;
}

LinkTime LinkPeer::NextDue() const
{
    LinkTime due = UrgentDue();
    for (const LinkSender *sender : _byNumber)
    {
        due = std::min(due, sender->NextDue(IsOpen()));
    }
    for (const auto &[queue, receiver] : _receivers)
    {
        due = std::min(due, receiver->NextDue());
    }
    return due;
}

}  // namespace Rabit
