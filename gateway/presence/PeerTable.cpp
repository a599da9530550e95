#include "presence/PeerTable.h"

#include <algorithm>
#include <utility>

#include "wire/Announcements.h"

namespace Rabit
{
namespace
{

using Gateway::NodeState;

// One straggler of an earlier life is no twin; this many beats are. Without more for this long it is
// forgotten.
constexpr int BeatsOfATwin = 3;
constexpr PeerTable::Duration TwinMemory = std::chrono::seconds(5);

PeerTable::Duration Nanoseconds(std::int64_t value)
{
    return PeerTable::Duration(value);
}

// Offers the peers in turn, from the one after `last` on, until `most` were taken.
template <typename Peers, typename Take>
void TakeTurns(Peers &peers, std::string &last, std::size_t most, const Take &take)
{
    std::size_t taken = 0;
    auto next = peers.upper_bound(last);
    for (std::size_t looked = 0; looked < peers.size() && taken < most; ++looked, ++next)
    {
        if (next == peers.end())
        {
            next = peers.begin();
        }
        if (take(next->second))
        {
            last = next->first;
            ++taken;
        }
    }
}

}  // namespace

PeerTable::PeerTable(std::string ownNode, std::uint64_t ownIncarnation, IsNeeded isNeeded)
    : _ownNode(std::move(ownNode)), _ownIncarnation(ownIncarnation), _isNeeded(std::move(isNeeded))
{
}

const PeerTable::Peer *PeerTable::Find(const std::string &node) const
{
    const auto found = _peers.find(node);
    return found == _peers.end() ? nullptr : &found->second;
}

std::vector<const PeerTable::Peer *> PeerTable::Heard() const
{
    std::vector<const Peer *> heard;
    for (const auto &[name, peer] : _peers)
    {
        if (peer.Heard)
        {
            heard.push_back(&peer);
        }
    }
    return heard;
}

PeerTable::Peer *PeerTable::GetOrMake(const std::string &node, bool heard, Duration now, Change &change)
{
    const auto found = _peers.find(node);
    if (found != _peers.end())
    {
        return &found->second;
    }
    if (_peers.size() >= MaximumPeers && !ForgetOne(heard, change))
    {
        ++_crowdedOut;
        return nullptr;
    }
    Peer &made = _peers[node];
    made.Node = node;
    made.KnownSince = now;
    return &made;
}

// Anybody can announce names; so one that was never heard makes room first, and for no such name one that
// was.
bool PeerTable::ForgetOne(bool forOneHeard, Change &change)
{
    const auto rank = [](const Peer &peer)
    { return std::pair(peer.Heard, peer.Heard ? peer.LastHeard : peer.KnownSince); };
    auto first = _peers.end();
    for (auto peer = _peers.begin(); peer != _peers.end(); ++peer)
    {
        const bool possible = !peer->second.Heard || (forOneHeard && peer->second.State == NodeState::LOST);
        if (possible && (first == _peers.end() || rank(peer->second) < rank(first->second)) &&
            !(_isNeeded && _isNeeded(peer->first)))
        {
            first = peer;
        }
    }
    if (first == _peers.end())
    {
        return false;
    }
    change.State |= first->second.Heard;
    change.Forgotten.push_back(first->first);
    ++_forgotten;
    _peers.erase(first);
    return true;
}

// A higher incarnation is a later life. A lower one is an earlier life's straggler, unless the later life has
// fallen silent: a node that lost its counter and its clock comes back with a lower number.
bool PeerTable::IsNewLife(const Peer &peer, std::uint64_t incarnation, Duration now) const
{
    return !peer.Heard || incarnation > peer.Incarnation ||
           (incarnation < peer.Incarnation && now - peer.LastHeard > StaleAfter);
}

void PeerTable::BeginLife(Peer &peer, std::uint64_t incarnation)
{
    if (peer.Offers && peer.Offers->incarnation != incarnation)
    {
        peer.Offers.reset();
    }
    peer.Incarnation = incarnation;
    peer.Clock = PeerClock();
    peer.LastBeatMonotonic = Duration(0);
    peer.LastEchoed.reset();
    peer.LacksOffersSince.reset();
    peer.Heard = false;
}

bool PeerTable::SetState(Peer &peer, NodeState state, const std::string &reason)
{
    const bool changed = peer.State != state || peer.Reason != reason;
    peer.State = state;
    peer.Reason = reason;
    return changed;
}

void PeerTable::NoteTwin(Peer &peer, Duration now)
{
    peer.TwinBeats = now - peer.TwinSince > TwinMemory ? 1 : peer.TwinBeats + 1;
    peer.TwinSince = now;
}

PeerTable::Change PeerTable::OnBeat(const Gateway::Beat &beat, Duration now)
{
    Change change;
    if (beat.node == _ownNode)
    {
        if (beat.incarnation != _ownIncarnation)
        {
            _ownTwinBeats = now - _ownTwinSince > TwinMemory ? 1 : _ownTwinBeats + 1;
            _ownTwinSince = now;
            change.State = !_ownTwice && _ownTwinBeats >= BeatsOfATwin;
            _ownTwice = _ownTwice || change.State;
        }
        return change;
    }
    Peer *peer = GetOrMake(beat.node, true, now, change);
    if (peer == nullptr)
    {
        return change;
    }
    if (!peer->Heard || beat.incarnation != peer->Incarnation)
    {
        if (!IsNewLife(*peer, beat.incarnation, now))
        {
            NoteTwin(*peer, now);
            change.State = !peer->Twice && peer->TwinBeats >= BeatsOfATwin;
            peer->Twice = peer->Twice || change.State;
            return change;
        }
        BeginLife(*peer, beat.incarnation);
        peer->FirstHeard = now;
        change.NewLife = true;
    }
    const Duration monotonic = Nanoseconds(beat.monotonic_ns);
    if (peer->Heard && monotonic <= peer->LastBeatMonotonic)
    {
        return change;  // a duplicate, or overtaken
    }
    peer->Clock.OnBeat(
        {.Monotonic = monotonic, .Source = Nanoseconds(beat.source_ns), .Wall = Nanoseconds(beat.utc_ns)},
        now);
    MeasureRoundTrip(*peer, beat, now);
    CompareOffers(*peer, beat.offers, now);
    peer->LastBeatMonotonic = monotonic;
    peer->LastBeatArrival = now;
    // A beat that was held up on the way tells of the past.
    peer->LastHeard = std::min(now, peer->Clock.SentAt(monotonic).value_or(now));
    peer->Heard = true;
    if (now - peer->LastHeard <= StaleAfter)
    {
        change.State = SetState(*peer, NodeState::UP, "") || change.NewLife;
    }
    return change;
}

void PeerTable::MeasureRoundTrip(Peer &peer, const Gateway::Beat &beat, Duration now) const
{
    for (const Gateway::BeatEcho &echo : beat.echoes)
    {
        if (echo.node == _ownNode && echo.incarnation == _ownIncarnation)
        {
            peer.Clock.OnRoundTrip(now - Nanoseconds(echo.monotonic_ns) - Nanoseconds(echo.held_ns), now);
        }
    }
}

PeerTable::Change PeerTable::OnAnnouncement(const Gateway::Announcement &announcement, Duration now)
{
    Change change;
    if (announcement.node == _ownNode)
    {
        return change;
    }
    Peer *peer = GetOrMake(announcement.node, false, now, change);
    if (peer == nullptr || (peer->Heard && announcement.incarnation < peer->Incarnation))
    {
        return change;
    }
    if (announcement.leaving)
    {
        change.State |= OnLeft(announcement.node, announcement.incarnation).State;
        return change;
    }
    change.Offers = !peer->Offers || !(*peer->Offers == announcement);
    if (change.Offers)
    {
        peer->Offers = announcement;
        peer->OffersSince = now;
        peer->OffersDigest = Announcements::DigestOf(announcement);
    }
    return change;
}

void PeerTable::CompareOffers(Peer &peer, std::uint32_t digest, Duration now)
{
    if (peer.Offers && peer.OffersDigest == digest)
    {
        peer.LacksOffersSince.reset();
    }
    else if (!peer.LacksOffersSince)
    {
        peer.LacksOffersSince = now;
    }
}

PeerTable::Change PeerTable::OnLeft(const std::string &node, std::uint64_t incarnation)
{
    Change change;
    const auto found = _peers.find(node);
    if (found != _peers.end() && found->second.Heard && found->second.Incarnation == incarnation)
    {
        change.State = SetState(found->second, NodeState::LOST, "left");
    }
    return change;
}

PeerTable::Change PeerTable::Advance(Duration now)
{
    Change change;
    if (_ownTwice && now - _ownTwinSince > TwinMemory)
    {
        _ownTwice = false;
        change.State = true;
    }
    for (auto &[name, peer] : _peers)
    {
        if (peer.Twice && now - peer.TwinSince > TwinMemory)
        {
            peer.Twice = false;
            change.State = true;
        }
        if (!peer.Heard)
        {
            continue;
        }
        const Duration silence = now - peer.LastHeard;
        if (silence > LostAfter && peer.State != NodeState::LOST)
        {
            change.State |= SetState(peer, NodeState::LOST, "not heard for 3.5 seconds");
        }
        else if (silence > StaleAfter && peer.State == NodeState::UP)
        {
            change.State |= SetState(peer, NodeState::STALE, "not heard for 1.5 seconds");
        }
    }
    return change;
}

std::optional<PeerTable::Duration> PeerTable::NextChange() const
{
    std::optional<Duration> next;
    const auto consider = [&next](Duration when) { next = next ? std::min(*next, when) : when; };
    // Just after the limit, because Advance compares with `>`.
    constexpr Duration after(1);
    if (_ownTwice)
    {
        consider(_ownTwinSince + TwinMemory + after);
    }
    for (const auto &[name, peer] : _peers)
    {
        if (peer.Twice)
        {
            consider(peer.TwinSince + TwinMemory + after);
        }
        if (peer.Heard && peer.State != NodeState::LOST)
        {
            consider(peer.LastHeard + (peer.State == NodeState::UP ? StaleAfter : LostAfter) + after);
        }
    }
    return next;
}

std::vector<std::string> PeerTable::NextWanted(Duration now, std::size_t most)
{
    std::vector<std::string> wanted;
    TakeTurns(_peers, _lastWanted, most,
              [&](const Peer &peer)
              {
                  const bool ask = peer.State != NodeState::LOST && peer.LacksOffersSince &&
                                   now - *peer.LacksOffersSince >= AskAfter;
                  if (ask)
                  {
                      wanted.push_back(peer.Node);
                  }
                  return ask;
              });
    return wanted;
}

std::vector<Gateway::BeatEcho> PeerTable::NextEchoes(Duration now, std::size_t most)
{
    std::vector<Gateway::BeatEcho> echoes;
    TakeTurns(_peers, _lastEchoed, most,
              [&](Peer &peer)
              {
                  if (!peer.Heard || peer.State == NodeState::LOST ||
                      (peer.LastEchoed && now - *peer.LastEchoed < EchoPeriod))
                  {
                      return false;
                  }
                  Gateway::BeatEcho echo;
                  echo.node = peer.Node;
                  echo.incarnation = peer.Incarnation;
                  echo.monotonic_ns = peer.LastBeatMonotonic.count();
                  echo.held_ns = (now - peer.LastBeatArrival).count();
                  echoes.push_back(std::move(echo));
                  peer.LastEchoed = now;
                  return true;
              });
    return echoes;
}

}  // namespace Rabit
