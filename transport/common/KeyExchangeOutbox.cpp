#include "common/KeyExchangeOutbox.h"

#include <algorithm>
#include <utility>

namespace Rabit
{

namespace
{

// True if a peer that has sent `theirs` no longer needs our message `ours`.
bool IsPast(KeyExchange::Step ours, KeyExchange::Step theirs)
{
    using Step = KeyExchange::Step;
    switch (theirs)
    {
        case Step::Final:
            return ours == Step::Reply || ours == Step::Ask;
        case Step::Keys:
        case Step::Reply:
            return ours == Step::Request || ours == Step::Ask;
        case Step::Request:
            return ours == Step::Ask;
        default:
            return false;
    }
}

// True if `theirs` answers `said`.
bool Answers(std::optional<KeyExchange::Step> said, KeyExchange::Step theirs)
{
    using Step = KeyExchange::Step;
    const bool isHandshake = theirs != Step::Keys && theirs != Step::Control;
    return !isHandshake || (said && IsPast(*said, theirs));
}

}  // namespace

KeyExchangeOutbox::Duration KeyExchangeOutbox::GapNow() const
{
    return _answerTime ? std::clamp<Duration>(2 * *_answerTime, ShortestGap, LongestFirstGap)
                       : Duration(FirstGap);
}

KeyExchangeOutbox::Duration KeyExchangeOutbox::ControlGapNow() const
{
    return _answerTime ? std::clamp<Duration>(2 * *_answerTime, ShortestControlGap, LongestFirstControlGap)
                       : Duration(FirstControlGap);
}

KeyExchangeOutbox::Duration KeyExchangeOutbox::LongControlGapNow() const
{
    constexpr int Times = 4;
    return _answerTime ? std::clamp<Duration>(Times * *_answerTime, ShortestLongControlGap, LongestControlGap)
                       : Duration(LongestControlGap);
}

void KeyExchangeOutbox::BeginControlAnew(Peer &peer)
{
    for (auto &[kind, control] : peer.Controls)
    {
        control.Gap = std::min(control.Gap, ControlGapNow());
        control.Due = std::min(control.Due, control.SaidAt + control.Gap);
    }
}

void KeyExchangeOutbox::ForgetOldest()
{
    const auto oldest = std::min_element(_peers.begin(), _peers.end(),
                                         [](const auto &one, const auto &other)
                                         { return one.second.TouchedAt < other.second.TouchedAt; });
    Forget(oldest);
}

void KeyExchangeOutbox::Forget(std::map<KeyExchange::Prefix, Peer>::iterator peer)
{
    Settle(peer->second);
    for (const Keys &keys : peer->second.KeysWaiting)
    {
        _waiting -= keys.What.Bytes.size();
    }
    _peers.erase(peer);
}

void KeyExchangeOutbox::Forget(const KeyExchange::Prefix &peer)
{
    if (const auto found = _peers.find(peer); found != _peers.end())
    {
        Forget(found);
    }
}

bool KeyExchangeOutbox::IsWaiting(const KeyExchange::Prefix &peer) const
{
    const auto found = _peers.find(peer);
    return found != _peers.end() && found->second.Waiting &&
           found->second.Waiting->What != found->second.Said;
}

KeyExchangeOutbox::Peer &KeyExchangeOutbox::PeerOf(const KeyExchange::Prefix &name, TimePoint now)
{
    if (_peers.size() >= MostPeers && !_peers.contains(name))
    {
        ForgetOldest();
    }
    Peer &peer = _peers[name];
    peer.TouchedAt = now;
    return peer;
}

bool KeyExchangeOutbox::Put(std::span<const std::uint8_t> datagram, const KeyExchange &what,
                            std::uint64_t route, TimePoint now)
{
    if (what.IsIdle || what.IsForOther)
    {
        return true;
    }
    if (what.IsWhole ? !IsHeld(what, now) : what.To == KeyExchange::Prefix{})
    {
        return false;
    }
    Peer &peer = PeerOf(what.To, now);
    if (!what.IsWhole && what.What != Step::Control)
    {
        Exchanged(peer, now);
    }
    Datagram copy{.Route = route, .Bytes = {datagram.begin(), datagram.end()}};
    if (what.IsHandshake())
    {
        PutHandshake(peer, std::move(copy), what, now);
    }
    else if (what.What == Step::Control)
    {
        PutControl(peer, std::move(copy), what, now);
    }
    else if (_waiting + datagram.size() <= MostWaiting)
    {
        _waiting += datagram.size();
        peer.KeysWaiting.push_back({std::move(copy), what.Source, what.IsWhole, now, ++_turn});
    }
    return true;
}

void KeyExchangeOutbox::Exchanged(Peer &peer, TimePoint now)
{
    ForgetAnswersIfSettled(now);
    if (now - peer.ExchangedAt >= Settled)
    {
        peer.StampedAt.reset();
    }
    peer.ExchangedAt = _exchangedAt = now;
}

void KeyExchangeOutbox::ForgetAnswersIfSettled(TimePoint now)
{
    if (now - _exchangedAt >= Settled)
    {
        _answerTime.reset();
        _window = FirstWindow;
    }
}

bool KeyExchangeOutbox::IsHeld(const KeyExchange &what, TimePoint now) const
{
    if (what.To == KeyExchange::Prefix{})
    {
        return what.What == Step::Control && now - _exchangedAt < Settled;
    }
    const auto found = _peers.find(what.To);
    return found != _peers.end() &&
           (!found->second.KeysWaiting.empty() || now - found->second.ExchangedAt < Settled);
}

void KeyExchangeOutbox::PutHandshake(Peer &peer, Datagram datagram, const KeyExchange &what, TimePoint now)
{
    const bool isOfWaiting = peer.Waiting && peer.Waiting->Number == what.Number;
    const bool isOfSaid = peer.Said && peer.SaidNumber == what.Number;
    if (isOfWaiting && peer.Waiting->Datagrams.size() < MostDatagrams)
    {
        peer.Waiting->Datagrams.push_back(datagram);
    }
    if (isOfSaid && peer.Rest.size() < MostDatagrams)
    {
        if (peer.Said == Step::Final)
        {
            peer.SaidFinal.push_back(datagram);
        }
        peer.Rest.push_back(std::move(datagram));
    }
    // A fragment alone: a newer message has replaced the one that it belongs to.
    if (isOfWaiting || isOfSaid || what.What == Step::Rest)
    {
        return;
    }
    const Turn place = peer.Waiting ? peer.Waiting->Place : ++_turn;
    const TimePoint since = peer.Waiting ? peer.Waiting->Since : now;
    const TimePoint due = peer.Waiting && peer.Waiting->What == what.What ? peer.Waiting->Due
                          : peer.Said == what.What                        ? std::max(now, peer.SaidAgainAt)
                                                                          : now;
    peer.Waiting = Message{.What = what.What,
                           .Number = what.Number,
                           .Datagrams = {},
                           .Since = since,
                           .PutAt = now,
                           .Due = due,
                           .Place = place};
    peer.Waiting->Datagrams.push_back(std::move(datagram));
}

void KeyExchangeOutbox::PutControl(Peer &peer, Datagram datagram, const KeyExchange &what, TimePoint now)
{
    const ControlKind kind{.Route = datagram.Route, .Source = what.Source, .Size = datagram.Bytes.size()};
    if (peer.Controls.size() >= MostControls && !peer.Controls.contains(kind))
    {
        peer.Controls.clear();
    }
    Control &control = peer.Controls[kind];
    if (control.Bytes.empty())
    {
        control.Place = ++_turn;
        control.Due = control.IsSaid ? std::max(now, control.SaidAt + control.Gap) : now;
    }
    control.Bytes = std::move(datagram.Bytes);
    control.IsWhole = what.IsWhole;
}

bool KeyExchangeOutbox::Received(const KeyExchange &what, TimePoint now)
{
    const auto found = _peers.find(what.From);
    if (found == _peers.end() || what.IsIdle)
    {
        return true;
    }
    Peer &peer = found->second;
    peer.TouchedAt = now;
    if (!what.IsWhole && what.What != Step::Control)
    {
        Exchanged(peer, now);
    }
    if (peer.Waiting && IsPast(peer.Waiting->What, what.What))
    {
        peer.Waiting.reset();
    }
    if (what.What == Step::Reply && peer.Said == Step::Final && !peer.Waiting)
    {
        peer.Waiting = Message{.What = Step::Final,
                               .Number = peer.SaidNumber,
                               .Datagrams = peer.SaidFinal,
                               .Since = now,
                               .PutAt = now,
                               .Due = std::max(now + FinalDelay, peer.SaidAgainAt),
                               .Place = ++_turn};
    }
    if (Answers(peer.Said, what.What))
    {
        peer.HandshakeAt = what.IsHandshake() && !what.IsWhole ? now : peer.HandshakeAt;
        // Nothing answers the last message.
        peer.Gap = peer.Said == Step::Final ? peer.Gap : Duration(0);
        Settle(peer);
    }
    if (what.What == Step::Keys)
    {
        BeginControlAnew(peer);
    }
    return what.What != Step::Control ||
           (peer.KeysWaiting.empty() && now - peer.KeysSaidAt >= _answerTime.value_or(Duration(0)));
}

KeyExchangeStamp KeyExchangeOutbox::StampFor(const KeyExchange::Prefix &peer, TimePoint now) const
{
    const auto ticks = [](Duration time)
    { return static_cast<std::uint32_t>(std::chrono::duration_cast<Milliseconds>(time).count()); };
    const Heard *const heard = _heard.Find(peer);
    const bool isNew = heard != nullptr && now - heard->At < LongestAnswer;
    return {.SentAt = ticks(now.time_since_epoch()),
            .Echo = isNew ? heard->SentAt + ticks(now - heard->At) : 0};
}

void KeyExchangeOutbox::Stamped(const KeyExchange::Prefix &from, const KeyExchangeStamp &stamp, TimePoint now)
{
    _heard.Put(from, {stamp.SentAt, now});
    const Milliseconds took(StampFor(from, now).SentAt - stamp.Echo);
    const auto peer = _peers.find(from);
    if (stamp.Echo == 0 || took > LongestAnswer || peer == _peers.end() || !peer->second.StampedAt ||
        now - peer->second.ExchangedAt >= Settled || took > now - *peer->second.StampedAt + Rounding)
    {
        return;
    }
    _answerTime = std::max<Duration>(took, _answerTime.value_or(took) / 2);
    if (took <= Quick)
    {
        _window = std::min(_window + FirstWindow / 4, LargestWindow);
    }
    else if (took > Late)
    {
        Lower(now);
    }
}

void KeyExchangeOutbox::Lower(TimePoint now)
{
    if (now - _loweredAt < GapNow())
    {
        return;
    }
    _loweredAt = now;
    _window = std::max(_window / 2, SmallestWindow);
}

void KeyExchangeOutbox::Expire(TimePoint now)
{
    ForgetAnswersIfSettled(now);
    for (auto &[name, peer] : _peers)
    {
        if (peer.Unanswered > 0 && peer.UnansweredUntil <= now)
        {
            Settle(peer);
        }
    }
}

}  // namespace Rabit
