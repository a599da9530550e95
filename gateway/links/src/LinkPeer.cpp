#include "LinkPeer.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace Rabit
{

LinkPeer::LinkPeer(LinkContext &context, std::string name, LinkTime now)
    : _context(context),
      _name(std::move(name)),
      _ownLife(context.Incarnation),
      _heardAt(now),
      _helloAt(now),
      _helloStep(2 * context.Settings.HelloGap)
{
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
        // The new life does not know us, and we have no token of it.
        HelloSoon(now);
        if (restarted)
        {
            ++_context.Counters.PeerRestarts;
            for (const auto &[queue, sender] : _senders)
            {
                sender->Restart();
            }
        }
    }
    HeardNow(now);
    return true;
}

void LinkPeer::HeardNow(LinkTime now)
{
    _heardAt = now;
    if (_silent)
    {
        _silent = false;
        HelloSoon(now);
    }
}

void LinkPeer::TakeToken(std::uint64_t clock, std::int64_t time, LinkTime now)
{
    if (clock != _token.Clock || time > _token.Time)
    {
        _token = {.Clock = clock, .Time = time, .CameAt = now};
    }
}

void LinkPeer::OnHello(const LinkHello &hello, LinkTime now)
{
    if (!HeardOf(hello.Incarnation, now))
    {
        return;
    }
    TakeToken(hello.Clock, hello.Time, now);
    if (hello.YourIncarnation != _ownLife)
    {
        // It does not know this life of ours yet.
        HelloSoon(now);
    }
    for (const auto &[queue, sender] : _senders)
    {
        sender->OnPeerHeard(now);
    }
}

void LinkPeer::HelloSoon(LinkTime now)
{
    const LinkTime earliest =
        _lastHelloAt == LinkNever ? now : std::max(now, _lastHelloAt + _context.Settings.HelloGap);
    _helloAt = std::min(_helloAt, earliest);
}

void LinkPeer::OnOwnRaise(LinkTime now)
{
    _ownLife = _context.Incarnation;
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
    auto sender = std::make_unique<LinkSender>(_context, _ownLife, _name, std::string(queue), options);
    return *_senders.emplace(std::string(queue), std::move(sender)).first->second;
}

LinkReceiver &LinkPeer::AddReceiver(std::string_view queue)
{
    auto receiver = std::make_unique<LinkReceiver>(_context, _ownLife, _name, std::string(queue));
    return *_receivers.emplace(std::string(queue), std::move(receiver)).first->second;
}

void LinkPeer::OnEnqueued(LinkTime now)
{
    if (_silent && _helloAt == LinkNever)
    {
        HelloSoon(now);
    }
}

bool LinkPeer::HasPending() const
{
    return std::any_of(_senders.begin(), _senders.end(),
                       [](const auto &entry) { return entry.second->HasPending(); });
}

void LinkPeer::Run(LinkTime now)
{
    _silent = IsSilentAt(now);
    for (const auto &[queue, receiver] : _receivers)
    {
        receiver->Run(_incarnation, now);
    }
    const PeerView view = View();
    for (const auto &[queue, sender] : _senders)
    {
        sender->Run(view, now);
    }
    RunHello(now);
}

void LinkPeer::RunHello(LinkTime now)
{
    if (now < _helloAt)
    {
        return;
    }
    LinkHello hello;
    hello.Source = _context.Settings.Node;
    hello.Destination = _name;
    hello.Incarnation = _ownLife;
    hello.YourIncarnation = _incarnation;
    hello.Clock = _context.Settings.Clock;
    hello.Time = now.count();
    _lastHelloAt = now;
    if (!_silent)
    {
        _helloAt = now + NextHelloStep();
    }
    else
    {
        _helloAt = HasPending() ? now + _context.Settings.SilentHelloPeriod : LinkNever;
    }
    ++_context.Counters.HellosSent;
    _context.Output.Send(hello);
}

// The first hello often comes before the network has matched the two nodes, and is lost.
LinkTime LinkPeer::NextHelloStep()
{
    const LinkTime period = _context.Settings.HelloPeriod;
    const LinkTime first = 2 * _context.Settings.HelloGap;
    if (_token.Clock != 0 || !HasPending())
    {
        _helloStep = first;
        return period;
    }
    const LinkTime step = std::min(std::max(_helloStep, first), period);
    _helloStep = 2 * step;
    return step;
}

LinkTime LinkPeer::NextDue() const
{
    LinkTime due = _helloAt;
    const PeerView view = View();
    for (const auto &[queue, sender] : _senders)
    {
        due = std::min(due, sender->NextDue(view));
    }
    for (const auto &[queue, receiver] : _receivers)
    {
        due = std::min(due, receiver->NextDue());
    }
    return due;
}

std::string LinkPeer::Describe() const
{
    std::ostringstream out;
    out << "peer " << _name << ": own life " << _ownLife << " life " << _incarnation << " token "
        << _token.Clock << ' ' << _token.Time << " of " << _token.CameAt.count() << " heard at "
        << _heardAt.count() << (_silent ? " silent" : "") << " hello at " << _helloAt.count() << " last "
        << _lastHelloAt.count() << '\n';
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
