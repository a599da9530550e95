#include "LinkPeer.h"

#include <rabit/gateway/links/LinkCheck.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace Rabit
{

namespace
{

// Numbers whose queues are asked for at once.
constexpr std::size_t MostUnknownLinks = 8;
constexpr std::int64_t Microsecond = 1000;

}  // namespace

LinkPeer::LinkPeer(LinkContext &context, std::string name, LinkTime now)
    : _context(context),
      _name(std::move(name)),
      _ownLife(context.Incarnation),
      _heardAt(now),
      _helloGap({context.Settings.HelloGap, context.Settings.HelloPeriod}),
      _path(context.Settings, context.Starting)
{
}

bool LinkPeer::Expand(LinkFrame &frame, LinkTime now) const
{
    if (!_token.Known() || frame.Check != LinkCheck::OfShort(_context.Settings.Node, _incarnation, _ownLife,
                                                             _token.Clock, _context.Clock))
    {
        return false;
    }
    frame.SenderLife = _incarnation;
    frame.ReceiverLife = _ownLife;
    frame.Clock = _token.Clock;
    frame.Echo.Clock = _context.Clock;
    // The peer's clock shows about this now; our clock is past the echoed reading.
    const std::int64_t expected = (_token.Time + (now - _token.CameAt).count()) / Microsecond;
    const auto behind = static_cast<std::int32_t>(static_cast<std::uint32_t>(expected) -
                                                  static_cast<std::uint32_t>(frame.Time / Microsecond));
    frame.Time = (expected - behind) * Microsecond;
    const std::int64_t mine = now.count() / Microsecond;
    const auto passed =
        static_cast<std::uint32_t>(mine) - static_cast<std::uint32_t>(frame.Echo.Time / Microsecond);
    frame.Echo.Time = (mine - static_cast<std::int64_t>(passed)) * Microsecond;
    return frame.Time >= 0 && frame.Echo.Time >= 0;
}

bool LinkPeer::IsIncredible(const LinkFrame &frame) const
{
    return frame.SenderLife > _incarnation && (frame.SenderLife >> 32) > LinkLargestClaim &&
           frame.Echo.Clock != _context.Clock;
}

bool LinkPeer::AreAcksPossible(const LinkFrame &frame) const
{
    if (frame.SenderLife != _incarnation || frame.ReceiverLife != _ownLife)
    {
        return true;
    }
    return std::all_of(frame.Acks.begin(), frame.Acks.end(),
                       [this](const LinkAck &ack)
                       { return ack.Link > _byNumber.size() || _byNumber[ack.Link - 1]->IsPossible(ack); });
}

bool LinkPeer::HeardOf(std::uint64_t incarnation, LinkTime now)
{
    if (incarnation < _incarnation)
    {
        HelloSoon(now);
        return false;
    }
    if (incarnation > _incarnation)
    {
        const bool restarted = _incarnation != 0;
        _incarnation = incarnation;
        _token = {};
        _knowsMe = false;
        _helloGap.Reset();
        _receiverOf.clear();
        _unknownLinks.clear();
        _refusals.clear();
        if (restarted)
        {
            ++_context.Counters.PeerRestarts;
            _askedSince = LinkNever;  // the former incarnation answers no more
            for (const auto &[queue, receiver] : _receivers)
            {
                receiver->SourceEnded();
            }
            for (const auto &[queue, sender] : _senders)
            {
                sender->Restart();
            }
        }
        if (HasPending())
        {
            HelloSoon(now);
        }
    }
    HeardNow(now);
    return true;
}

void LinkPeer::HeardNow(LinkTime now)
{
    // After an outage the measurements of the path may be wrong.
    if (_unansweredSince != LinkNever &&
        now - _unansweredSince > std::max(_context.Settings.MaxResend, 2 * _path.ProbeTimeout()))
    {
        _path.Restart();
        for (const auto &[queue, sender] : _senders)
        {
            sender->OnPeerHeard(now);
        }
    }
    _heardAt = now;
    _unansweredSince = LinkNever;
    _silent = false;
    _droppedBeyondGaps = false;
}

void LinkPeer::PathChanged(LinkTime now)
{
    _path.Replace();
    _askedSince = LinkNever;
    ProbeNow(now);
}

void LinkPeer::ProbeNow(LinkTime now)
{
    for (LinkSender *sender : _byNumber)
    {
        sender->ProbeNow(now);
    }
}

bool LinkPeer::TakeToken(std::uint32_t clock, std::int64_t time, LinkTime now)
{
    if (clock == _token.Clock && time <= _token.Time)
    {
        return false;
    }
    _token = {.Clock = clock, .Time = time, .CameAt = now};
    return true;
}

void LinkPeer::OnFrame(const LinkFrame &frame, LinkTime now)
{
    if (IsIncredible(frame))
    {
        ++_context.Counters.FalseClaims;
        HelloSoon(now);
        return;
    }
    if (!HeardOf(frame.SenderLife, now))  // rules S5 and R2
    {
        ++_context.Counters.Stale;
        return;
    }
    const bool isNewest = TakeToken(frame.Clock, frame.Time, now);
    if (frame.ReceiverLife != _ownLife)
    {
        // Rule R1: the peer does not know this node's present incarnation yet.
        _context.Counters.Stale += frame.IsHello() ? 0 : 1;
        _knowsMe = false;
        HelloSoon(now);
        return;
    }
    _helloGap.Reset();
    _knowsMe = frame.Echo.Clock == _context.Clock || (_knowsMe && frame.Echo.Clock == 0);
    if (frame.Ask && !frame.HasData)
    {
        HelloSoon(now);
    }
    if (isNewest)
    {
        Measure(frame, now);
    }
    OnAcks(frame, now);
    if (frame.HasData)
    {
        OnData(frame, now);
    }
}

void LinkPeer::Measure(const LinkFrame &frame, LinkTime now)
{
    const LinkTime sentAt(frame.Echo.Time);
    // The peer may echo a later frame that does not ask, such as an acknowledgement, in place of the
    // question.
    if (frame.Echo.Clock == _context.Clock && sentAt >= _askedSince && sentAt <= now)
    {
        _path.Answered(now - std::min(sentAt, _askedAt));
        _askedSince = LinkNever;
    }
    const LinkTime roundTrip = now - sentAt - LinkTime(frame.Echo.HeldFor);
    // An echo that was held for long tells more about the two clocks than about the path.
    if (frame.Echo.Clock == _context.Clock && sentAt <= now && roundTrip >= LinkTime(0) &&
        frame.Echo.HeldFor <= LinkTime(std::chrono::seconds(1)).count())
    {
        _path.Measured(roundTrip, sentAt, now);
    }
}

void LinkPeer::OnAcks(const LinkFrame &frame, LinkTime now)
{
    const bool echoed = frame.Echo.Clock == _context.Clock && frame.Echo.Time <= now.count();
    const LinkTime echo = echoed ? LinkTime(frame.Echo.Time) : LinkTime(0);
    for (const LinkAck &ack : frame.Acks)
    {
        if (ack.Link > _byNumber.size())
        {
            ++_context.Counters.NoSuchLink;
            continue;
        }
        _byNumber[ack.Link - 1]->OnAck(ack, frame.Time, echo, now);
    }
    for (LinkSender *sender : _byNumber)
    {
        sender->OnEcho(echo);
    }
}

void LinkPeer::OnData(const LinkFrame &frame, LinkTime now)
{
    LinkReceiver *receiver = ReceiverOf(frame.Data);
    if (receiver != nullptr)
    {
        receiver->OnData(frame, AckDelay(now), now);
    }
}

// An acknowledgement of a dialogue almost always goes with the next message of this node. If each frame set a
// time for it, each would cost a wake-up of the driver. So all that come within the longer delay share one
// time, which the probe timer of the peer still covers.
LinkTime LinkPeer::AckDelay(LinkTime now)
{
    const LinkTime plain = _context.Settings.AckDelay;
    const LinkTime pause = now - std::exchange(_dataAt, now);
    const bool isDialogue = _acksGoWithData && pause < plain;
    const RoundTrip &times = _path.Times();
    const LinkTime answered = times.Smoothed() + 4 * times.Variation() + 2 * plain;
    if (!isDialogue || !times.IsKnown() || answered >= _context.Settings.MinResend)
    {
        return _path.AckDelay();
    }
    _lookAt = now + 2 * plain;
    return 2 * plain;
}

LinkReceiver *LinkPeer::ReceiverOf(const LinkData &data)
{
    if (data.Queue.empty())
    {
        const auto known = _receiverOf.find(data.Link);
        if (known != _receiverOf.end())
        {
            return known->second;
        }
        if (_unknownLinks.size() < MostUnknownLinks &&
            std::find(_unknownLinks.begin(), _unknownLinks.end(), data.Link) == _unknownLinks.end())
        {
            _unknownLinks.push_back(data.Link);
        }
        return nullptr;
    }
    LinkReceiver *receiver = FindReceiver(data.Queue);
    if (receiver == nullptr && !_context.Queues.Accepts(_name, data.Queue))
    {
        Refuse(data);
        return nullptr;
    }
    if (receiver == nullptr)
    {
        if (_receivers.size() >= _context.Settings.MaxLinksPerPeer && !DropFormerReceiver())
        {
            ++_context.Counters.TooManyLinks;
            return nullptr;
        }
        std::string queue(data.Queue);
        receiver = _receivers.emplace(queue, std::make_unique<LinkReceiver>(_context, _name, queue))
                       .first->second.get();
    }
    // A peer that gives one queue many numbers must not fill the memory with them.
    if (_receiverOf.size() >= 4 * _context.Settings.MaxLinksPerPeer)
    {
        _receiverOf.clear();
    }
    _receiverOf[data.Link] = receiver;
    return receiver;
}

// A peer has no more links of its own at a time. So a peer whose queues had other names in former
// incarnations is heard nevertheless. A receiver that the peer still uses is made again with its next
// message.
bool LinkPeer::DropFormerReceiver()
{
    const auto former =
        std::find_if(_receivers.begin(), _receivers.end(),
                     [this](const auto &entry)
                     { return !entry.second->HasSessionOf(_incarnation) && !entry.second->KeepsParts(); });
    if (former == _receivers.end())
    {
        return false;
    }
    const LinkReceiver *const receiver = former->second.get();
    std::erase_if(_receiverOf, [receiver](const auto &entry) { return entry.second == receiver; });
    _receivers.erase(former);
    return true;
}

// Refuses all parts, whatever came before them or is missing between them. Only their numbers have to be
// remembered, until they are acknowledged.
void LinkPeer::Refuse(const LinkData &data)
{
    std::uint64_t refused = 0;
    for (const LinkItem &item : data.Items)
    {
        refused += (item.Flags & LinkFlagLast) != 0 ? 1 : 0;
    }
    _context.Counters.RefusedUnknown += refused;
    auto refusal = std::find_if(_refusals.begin(), _refusals.end(),
                                [&data](const Refusal &known) { return known.Link == data.Link; });
    if (refusal == _refusals.end())
    {
        if (_refusals.size() >= MostUnknownLinks)
        {
            return;  // the peer will ask again
        }
        refusal = _refusals.insert(refusal, {.Link = data.Link, .Oldest = data.Oldest});
    }
    refusal->Oldest = std::max(refusal->Oldest, data.Oldest);
    refusal->Through = std::max(refusal->Through, data.Items.back().Through);
}

void LinkPeer::HelloSoon(LinkTime now)
{
    const LinkTime earliest =
        _lastHelloAt == LinkNever ? now : std::max(now, _lastHelloAt + _helloGap.Interval());
    _helloAt = std::min(_helloAt, earliest);
}

void LinkPeer::OnOwnRaise(LinkTime now)
{
    _ownLife = _context.Incarnation;
    _knowsMe = false;
    _helloGap.Reset();
    _receiverOf.clear();
    _unknownLinks.clear();
    _refusals.clear();
    for (const auto &[queue, receiver] : _receivers)
    {
        receiver->DropSession();
    }
    for (const auto &[queue, sender] : _senders)
    {
        sender->Restart();
    }
    HelloSoon(now);
}

LinkSender *LinkPeer::FindSender(std::string_view queue) const
{
    const auto found = _senders.find(queue);
    return found == _senders.end() ? nullptr : found->second.get();
}

LinkReceiver *LinkPeer::FindReceiver(std::string_view queue) const
{
    const auto found = _receivers.find(queue);
    return found == _receivers.end() ? nullptr : found->second.get();
}

LinkSender &LinkPeer::AddSender(std::string_view queue, const LinkOptions &options)
{
    const auto number = static_cast<std::uint32_t>(_byNumber.size() + 1);
    auto sender = std::make_unique<LinkSender>(_context, _path, number, _name, std::string(queue), options);
    _byNumber.push_back(sender.get());
    return *_senders.emplace(std::string(queue), std::move(sender)).first->second;
}

bool LinkPeer::HasPending() const
{
    return std::any_of(_byNumber.begin(), _byNumber.end(),
                       [](const LinkSender *sender) { return sender->HasPending(); });
}

void LinkPeer::OnEnqueued(LinkTime now)
{
    if (!IsOpen() && _helloAt == LinkNever)
    {
        HelloSoon(now);
    }
}

std::string LinkPeer::Describe() const
{
    std::ostringstream out;
    out << "peer " << _name << ": own life " << _ownLife << " life " << _incarnation << " token "
        << _token.Clock << ' ' << _token.Time << " of " << _token.CameAt.count()
        << (_knowsMe ? " knows me" : "") << " heard at " << _heardAt.count() << " unanswered since "
        << _unansweredSince.count() << (_silent ? " silent" : "") << " hello at " << _helloAt.count()
        << " last " << _lastHelloAt.count() << " window " << _path.Window() << " in flight "
        << _path.InFlight() << " round trip " << _path.Times().Smoothed().count() << " numbers "
        << _receiverOf.size() << '\n';
    for (const auto &[queue, sender] : _senders)
    {
        out << sender->Describe() << '\n';
    }
    for (const auto &[queue, receiver] : _receivers)
    {
        out << receiver->Describe() << '\n';
    }
    return out.str();
}

}  // namespace Rabit
