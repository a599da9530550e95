// KeyExchangeOutbox: choice of the datagrams that go next.
#include "common/KeyExchangeOutbox.h"

#include <rabit/base/Assert.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

namespace Rabit
{

std::size_t KeyExchangeOutbox::SizeOf(const Message &message)
{
    std::size_t size = 0;
    for (const Datagram &datagram : message.Datagrams)
    {
        size += datagram.Bytes.size() + Headers;
    }
    return size;
}

bool KeyExchangeOutbox::IsBehindKeys(const Peer &peer, const ControlKind &kind)
{
    return !peer.KeysWaiting.empty() && peer.KeysWaiting.front().Source == kind.Source;
}

KeyExchangeOutbox::LastProgress KeyExchangeOutbox::FindLastProgress() const
{
    LastProgress last;
    for (const auto &[name, peer] : _peers)
    {
        if (peer.HandshakeAt > last.At)
        {
            last = {&peer, peer.HandshakeAt, last.At};
        }
        else
        {
            last.NextAt = std::max(last.NextAt, peer.HandshakeAt);
        }
    }
    return last;
}

// When the waiting message goes.
KeyExchangeOutbox::TimePoint KeyExchangeOutbox::DueOf(const Peer &peer, const LastProgress &last) const
{
    const Message &message = *peer.Waiting;
    const TimePoint othersAt = last.Of == &peer ? last.NextAt : last.At;
    if (message.What != Step::Request || othersAt == TimePoint{})
    {
        return message.Due;
    }
    const TimePoint calm = othersAt + Calm * _answerTime.value_or(FirstGap);
    return std::max(message.Due, std::min({calm, _requestedAt + LongestCalm, message.Since + LongestWait}));
}

bool KeyExchangeOutbox::IsBeyondShare(const Peer &peer, const Control &control) const
{
    return static_cast<double>(control.Bytes.size() + Headers) > peer.ControlAhead;
}

// Calls visit(choice) for each item that the window allows to go.
template <typename Visit>
void KeyExchangeOutbox::VisitChoices(const Visit &visit) const
{
    const LastProgress last = FindLastProgress();
    for (const auto &[name, peer] : _peers)
    {
        if (!peer.Rest.empty())
        {
            visit(Choice{.What = Step::Final, .Place = 0, .Due = TimePoint{}, .Of = name, .Kind = {}});
        }
        for (const auto &[kind, control] : peer.Controls)
        {
            if (!control.Bytes.empty() && !IsBehindKeys(peer, kind))
            {
                const bool isBeyond = IsBeyondShare(peer, control);
                const TimePoint slot = peer.ControlSaidAt + ControlGapNow();
                visit(Choice{.What = Step::Control,
                             .IsWhole = control.IsWhole && !isBeyond,
                             .Place = control.Place,
                             .Due = isBeyond ? std::max(control.Due, slot) : control.Due,
                             .Of = name,
                             .Kind = kind});
            }
        }
        if (peer.Waiting && (peer.Waiting->What == Step::Final || Fits(SizeOf(*peer.Waiting))))
        {
            visit(Choice{.What = peer.Waiting->What,
                         .Place = peer.Waiting->Place,
                         .Due = DueOf(peer, last),
                         .Of = name,
                         .Kind = {}});
        }
        if (!peer.KeysWaiting.empty() && Fits(peer.KeysWaiting.front().What.Bytes.size() + Headers))
        {
            const Keys &keys = peer.KeysWaiting.front();
            visit(Choice{.What = Step::Keys, .Place = keys.Place, .Due = keys.Since, .Of = name, .Kind = {}});
        }
    }
}

std::optional<KeyExchangeOutbox::TimePoint> KeyExchangeOutbox::Due() const
{
    std::optional<TimePoint> due;
    const auto notAfter = [&due](TimePoint time) { due = due ? std::min(*due, time) : time; };
    VisitChoices([&](const Choice &choice) { notAfter(choice.Due); });
    if (due)
    {
        due = std::max(*due, _freeAt);
    }
    for (const auto &[name, peer] : _peers)
    {
        if (peer.Unanswered > 0)
        {
            notAfter(peer.UnansweredUntil);
        }
    }
    return due;
}

std::optional<KeyExchangeOutbox::Choice> KeyExchangeOutbox::Next(TimePoint now) const
{
    std::optional<Choice> best;
    VisitChoices(
        [&](const Choice &choice)
        {
            if (choice.Due <= now && (!best || std::tie(choice.What, choice.IsWhole, choice.Place) <
                                                   std::tie(best->What, best->IsWhole, best->Place)))
            {
                best = choice;
            }
        });
    return best;
}

std::vector<KeyExchangeOutbox::Datagram> KeyExchangeOutbox::TakeDue(TimePoint now)
{
    std::vector<Datagram> taken;
    Expire(now);
    RABIT_ASSERT(_unanswered == std::accumulate(_peers.begin(), _peers.end(), std::size_t{0},
                                                [](std::size_t sum, const auto &peer)
                                                { return sum + peer.second.Unanswered; }));
    while (_freeAt <= now)
    {
        const auto next = Next(now);
        if (!next)
        {
            break;
        }
        Take(*next, now, taken);
    }
    return taken;
}

void KeyExchangeOutbox::Take(const Choice &choice, TimePoint now, std::vector<Datagram> &taken)
{
    Peer &peer = _peers.at(choice.Of);
    const auto from = static_cast<std::ptrdiff_t>(taken.size());
    bool waits = true;
    bool isWhole = false;
    if (choice.Kind)
    {
        Control &control = peer.Controls.at(*choice.Kind);
        taken.push_back({choice.Kind->Route, std::exchange(control.Bytes, {})});
        control.Gap = std::exchange(control.IsSaid, true)
                          ? std::min<Duration>(2 * control.Gap, LongControlGapNow())
                          : ControlGapNow();
        control.SaidAt = peer.ControlSaidAt = now;
        isWhole = control.IsWhole;
        waits = false;
    }
    else if (choice.What == Step::Keys)
    {
        isWhole = peer.KeysWaiting.front().IsWhole;
        _waiting -= peer.KeysWaiting.front().What.Bytes.size();
        taken.push_back(std::move(peer.KeysWaiting.front().What));
        peer.KeysWaiting.pop_front();
        peer.KeysSaidAt = now;
        BeginControlAnew(peer);
    }
    else if (!peer.Rest.empty())
    {
        std::move(peer.Rest.begin(), peer.Rest.end(), std::back_inserter(taken));
        peer.Rest.clear();
    }
    else
    {
        TakeMessage(peer, now, taken);
    }
    std::size_t size = 0;
    std::for_each(taken.begin() + from, taken.end(),
                  [&](Datagram &datagram)
                  {
                      if (!isWhole)  // the signature of a whole message covers its end
                      {
                          StampFor(choice.Of, now).AppendTo(datagram.Bytes);
                          peer.StampedAt = peer.StampedAt.value_or(now);
                      }
                      size += datagram.Bytes.size() + Headers;
                  });
    peer.ControlAhead += static_cast<double>(size) * (choice.Kind ? -1.0 : ControlShare);
    peer.ControlAhead = std::clamp(peer.ControlAhead, 0.0, MostControlAhead);
    Charge(peer, size, waits, now);
}

void KeyExchangeOutbox::TakeMessage(Peer &peer, TimePoint now, std::vector<Datagram> &taken)
{
    Message &message = *peer.Waiting;
    const bool again = peer.Said == message.What;
    if (again && peer.Gap > Duration(0))
    {
        peer.Gap = std::min(3 * peer.Gap / 2, std::max<Duration>(LongestGap, GapNow()));
        Settle(peer);  // the earlier copies
    }
    else
    {
        peer.Gap = GapNow();
    }
    peer.Said = message.What;
    if (!again)
    {
        peer.HandshakeAt = peer.Said == Step::Ask ? peer.HandshakeAt : now;
        _requestedAt = peer.Said == Step::Request ? now : _requestedAt;
    }
    peer.SaidNumber = message.Number;
    peer.SaidAgainAt = message.Due = now + peer.Gap;
    peer.Rest.clear();
    std::copy(message.Datagrams.begin(), message.Datagrams.end(), std::back_inserter(taken));
    message.Place = ++_turn;
    if (peer.Said == Step::Final)
    {
        peer.SaidFinal = std::move(message.Datagrams);
    }
    if (peer.Said == Step::Final || now - message.PutAt >= LongestSilence)
    {
        peer.Waiting.reset();
    }
}

void KeyExchangeOutbox::Charge(Peer &peer, std::size_t size, bool waits, TimePoint now)
{
    if (_most > 0.0)
    {
        const std::chrono::duration<double> time(static_cast<double>(size) / _most);
        _freeAt = std::max(_freeAt, now) + std::chrono::duration_cast<Duration>(time);
    }
    if (!waits)
    {
        return;
    }
    peer.Unanswered += size;
    peer.UnansweredUntil = now + std::max(peer.Gap, GapNow());
    _unanswered += size;
}

}  // namespace Rabit
