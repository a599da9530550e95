#include "presence/PeerTable.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <utility>

#include "names/NodeTag.h"
#include "names/TakeTurns.h"
#include "presence/Whereabouts.h"
#include "wire/Announcements.h"
#include "wire/BeatExtensions.h"
#include "wire/BeatNews.h"

namespace Rabit
{
namespace
{

using Gateway::NodeState;

// Beats of another incarnation that prove a twin, each after a beat of the present one: a former life that
// was killed is not heard again, and one straggler of it is no proof. A twin is forgotten after this silence.
constexpr int BeatsOfATwin = 3;
constexpr PeerTable::Duration TwinMemory = std::chrono::seconds(5);

std::string NoBeatWithin(PeerTable::Duration limit)
{
    char text[64];
    std::snprintf(text, sizeof text, "no beat within its limit of %g s",
                  std::chrono::duration<double>(limit).count());
    return text;
}

// Where the beat says that its node runs, or else the place that was known.
std::string PlaceIn(const Gateway::Beat &beat, const std::string &known)
{
    std::string place = Whereabouts::In(beat);
    return place.empty() ? known : place;
}

}  // namespace

PeerTable::PeerTable(std::string ownNode, std::uint64_t ownIncarnation, IsNeeded isNeeded)
    : _ownNode(std::move(ownNode)),
      _ownIncarnation(ownIncarnation),
      _ownTag(NodeTagOf(_ownNode, ownIncarnation)),
      _isNeeded(std::move(isNeeded))
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
    heard.reserve(_peers.size());
    for (const auto &[name, peer] : _peers)
    {
        if (!peer.IsTool)
        {
            heard.push_back(&peer);
        }
    }
    return heard;
}

PeerTable::Peer *PeerTable::GetOrMake(const std::string &node, Change &change)
{
    const auto found = _peers.find(node);
    if (found != _peers.end())
    {
        return &found->second;
    }
    if (_peers.size() - _tools >= MaximumPeers && !ForgetOne(change))
    {
        ++_crowdedOut;
        return nullptr;
    }
    Peer &made = _peers[node];
    made.Node = node;
    change.NewLife = true;
    return &made;
}

bool PeerTable::ForgetOne(Change &change)
{
    auto first = _peers.end();
    for (auto peer = _peers.begin(); peer != _peers.end(); ++peer)
    {
        if (peer->second.State == NodeState::LOST &&
            (first == _peers.end() || peer->second.LastHeard < first->second.LastHeard) &&
            !(_isNeeded && _isNeeded(peer->first)))
        {
            first = peer;
        }
    }
    if (first == _peers.end())
    {
        return false;
    }
    change.State = true;
    change.Forgotten.push_back(first->first);
    ++_forgotten;
    _missing.LetGo(first->first);
    _peers.erase(first);
    return true;
}

// A higher incarnation is a later life. A lower one is an earlier life's straggler, unless the later life has
// said goodbye or has fallen silent: a node that lost its counter and its clock comes back with a lower
// number. Two beats that come as far apart as they were sent prove it: one alone may be late.
bool PeerTable::IsNewLife(Peer &peer, const HeardBeat &heard)
{
    if (heard.Incarnation >= peer.Incarnation)
    {
        return heard.Incarnation > peer.Incarnation;
    }
    const bool isOver = peer.State == NodeState::LOST || heard.Arrival - peer.LastHeard > peer.StaleAfter();
    const Peer::Earlier now{heard.Incarnation, Duration(heard.Beat.source_ns), heard.Arrival};
    auto &before = peer.OfEarlierLife;
    if (!before ||
        (before->Incarnation != now.Incarnation && now.Arrival - before->Arrival > peer.StaleAfter()))
    {
        before = now;
    }
    if (before->Incarnation != now.Incarnation)
    {
        return false;
    }
    const Peer::Earlier last = std::exchange(*before, now);
    const Duration late = (now.Arrival - last.Arrival) - (now.Source - last.Source);
    return isOver && now.Source > last.Source && std::max(late, -late) <= peer.StaleAfter();
}

void PeerTable::BeginLife(Peer &peer, const HeardBeat &heard)
{
    // A node that restarts with the same announcement need not be asked.
    if (peer.OffersDigest != heard.Beat.offers)
    {
        peer.Offers.reset();
    }
    peer.Incarnation = heard.Incarnation;
    peer.Tag = NodeTagOf(heard.Node, heard.Incarnation);
    peer.FirstHeard = heard.Arrival;
    peer.Clock = PeerClock();
    peer.Beats = BeatCount();
    peer.LastBeatSource = Duration(-1);
    peer.LastEchoed.reset();
    peer.DoubtsThisNode = false;
    peer.States.clear();
    // Of two nodes with this name, the one with the higher incarnation is the peer: the earlier one is the
    // twin now.
    peer.TwinPlace = peer.Twice ? std::exchange(peer.Place, {}) : "";
    peer.Place.clear();
    peer.Problems = {};
    peer.HasToldProblems = false;
    peer.FleetSum.reset();
}

bool PeerTable::SetState(Peer &peer, NodeState state, const std::string &reason)
{
    const bool changed = peer.State != state || peer.Reason != reason;
    peer.State = state;
    peer.Reason = reason;
    if (state == NodeState::LOST)
    {
        _missing.LetGo(peer.Node);
    }
    return changed;
}

// Returns true if this beat has proved that two nodes have the name.
bool PeerTable::NoteTwin(Peer &peer, const HeardBeat &heard)
{
    const Duration now = heard.Arrival;
    peer.TwinPlace = PlaceIn(heard.Beat, peer.TwinPlace);
    if (now - peer.TwinSince > TwinMemory)
    {
        peer.TwinBeats = 1;
    }
    else if (peer.LastBeatArrival >= peer.TwinSince)
    {
        ++peer.TwinBeats;
    }
    peer.TwinSince = now;
    const bool news = !peer.Twice && peer.TwinBeats >= BeatsOfATwin;
    peer.Twice = peer.Twice || news;
    Expect(peer);
    return news;
}

PeerTable::Change PeerTable::OnOwnName(const HeardBeat &heard)
{
    Change change;
    if (heard.Incarnation != _ownIncarnation)
    {
        _ownTwinBeats = heard.Arrival - _ownTwinSince > TwinMemory ? 1 : _ownTwinBeats + 1;
        _ownTwinSince = heard.Arrival;
        _ownTwinPlace = PlaceIn(heard.Beat, _ownTwinPlace);
        change.State = !_ownTwice && _ownTwinBeats >= BeatsOfATwin;
        _ownTwice = _ownTwice || change.State;
        _nextChange = std::min(_nextChange, OwnChange());
    }
    return change;
}

PeerTable::Change PeerTable::OnBeat(const HeardBeat &heard)
{
    if (heard.Node == _ownNode)
    {
        return OnOwnName(heard);
    }
    if (heard.Beat.leaving)
    {
        return OnGoodbye(heard);
    }
    if (BeatExtensions::IsTool(heard.Beat))
    {
        return OnToolBeat(heard);
    }
    Change change;
    if (const auto tool = _peers.find(heard.Node); tool != _peers.end() && tool->second.IsTool)
    {
        ForgetTool(tool, change);  // a node of this name has come
    }
    Peer *peer = GetOrMake(heard.Node, change);
    if (peer == nullptr)
    {
        return change;
    }
    if (change.NewLife || heard.Incarnation != peer->Incarnation)
    {
        if (!change.NewLife && !IsNewLife(*peer, heard))
        {
            change.State = NoteTwin(*peer, heard);
            return change;
        }
        BeginLife(*peer, heard);
        change.NewLife = true;
    }
    if (Duration(heard.Beat.source_ns) > peer->LastBeatSource)  // else a duplicate, or overtaken
    {
        TakeIn(*peer, heard, change);
    }
    Expect(*peer);
    return change;
}

// Returns whether it has changed. The end of the problems may be lost: they are forgotten after some time.
bool PeerTable::TakeProblems(Peer &peer, const HeardBeat &heard)
{
    const ProblemCount before = peer.Problems;
    if (const std::optional<ProblemCount> told = BeatExtensions::ProblemsIn(heard.Beat))
    {
        peer.Problems = *told;
        peer.HasToldProblems = true;
        peer.ProblemsTold = heard.Arrival;
    }
    else if (heard.Arrival - peer.ProblemsTold > std::max(ProblemMemory, 2 * peer.LostAfter()))
    {
        peer.Problems = {};
    }
    return before != peer.Problems;
}

void PeerTable::TakeIn(Peer &peer, const HeardBeat &heard, Change &change)
{
    Measure(peer, heard);
    const std::uint64_t missed = peer.Beats.Missed();
    peer.Beats.Add(heard.Sequence);
    if (peer.Beats.Missed() != missed)
    {
        change.Missed.push_back(peer.Node);
    }
    peer.IsReplay = BeatExtensions::IsReplay(heard.Beat);
    peer.Strains = BeatExtensions::StrainsIn(heard.Beat);
    const bool hearsHereFirst = BeatExtensions::IsFirstHeardHere(heard.Beat, _ownTag);
    change.State |= std::exchange(peer.HearsHereFirst, hearsHereFirst) != hearsHereFirst;
    change.State |= TakeProblems(peer, heard);
    if (const std::optional<std::uint32_t> told = BeatExtensions::FleetSumIn(heard.Beat))
    {
        const bool isNew = std::exchange(peer.FleetSum, told) != told;
        change.State |= _isTool && isNew;
    }
    change.Beat = true;
    if (heard.Arrival - peer.LastHeard <= peer.StaleAfter())
    {
        change.State |= SetState(peer, NodeState::UP, "") || change.NewLife;
    }
    CompareOffers(peer, heard, change);
    TakeStates(peer, heard.Beat);
}

void PeerTable::Measure(Peer &peer, const HeardBeat &heard) const
{
    const Gateway::Beat &beat = heard.Beat;
    const Duration source(beat.source_ns);
    const Duration now = heard.Arrival;
    peer.Place = PlaceIn(beat, peer.Place);
    peer.Clock.OnBeat({.Source = source, .Wall = Duration(heard.Utc)}, now);
    peer.DoubtsThisNode |= peer.Clock.StoodStillHere();
    MeasureRoundTrip(peer, heard);
    peer.LastBeatSource = source;
    peer.LastBeatArrival = now;
    // A beat that was held up on the way was sent earlier.
    peer.LastHeard = std::min(now, peer.Clock.SentAt(source).value_or(now));
    peer.Period =
        std::clamp(Duration(std::chrono::milliseconds(beat.next_ms)), ShortestPeriod, LongestPeriod);
}

// An echo of a beat that this node has not sent is a mistake or a lie. How long the peer says to have held it
// can only make its own clock look wrong.
void PeerTable::MeasureRoundTrip(Peer &peer, const HeardBeat &heard) const
{
    const auto &echoes = NewsOf(heard.Beat).echoes;
    const auto own =
        std::find_if(echoes.begin(), echoes.end(), [this](const auto &echo) { return echo.node == _ownTag; });
    const std::optional<Duration> sent = own == echoes.end() ? std::nullopt : _sent.Find(own->beat);
    if (sent)
    {
        peer.Clock.OnRoundTrip(heard.Arrival - *sent - std::chrono::microseconds(own->held_us),
                               heard.Arrival);
    }
}

void PeerTable::TakeStates(Peer &peer, const Gateway::Beat &beat)
{
    if (peer.BeatsOffers != beat.offers)
    {
        peer.BeatsOffers = beat.offers;
        peer.States.clear();
    }
    const auto &states = NewsOf(beat).states;
    const std::size_t first = NewsOf(beat).first_state;
    if (!states.empty())
    {
        peer.States.resize(std::max(peer.States.size(), first + states.size()), 0);
        std::copy(states.begin(), states.end(), peer.States.begin() + static_cast<std::ptrdiff_t>(first));
    }
}

void PeerTable::CompareOffers(Peer &peer, const HeardBeat &heard, Change &change)
{
    const Gateway::Beat &beat = heard.Beat;
    if (peer.Offers && peer.OffersDigest == beat.offers)
    {
        _missing.LetGo(peer.Node);
        return;
    }
    if (peer.State == NodeState::LOST || (_isAsked && !_isAsked(peer.Node)) ||
        (peer.Offers && !change.NewLife && heard.Arrival - peer.OffersSince < OffersRest))
    {
        return;
    }
    _missing.Lacks(peer.Node, beat.offers, heard.Arrival);
    const auto &parts = NewsOf(beat).parts;
    const bool hasPart = !parts.empty() && !Whereabouts::IsIn(parts.front());
    const auto whole = hasPart ? _missing.Add(peer.Node, parts.front()) : std::nullopt;
    if (!whole)
    {
        return;
    }
    auto announcement = Announcements::Decode(*whole);
    if (!announcement)
    {
        ++_malformed;
        return;
    }
    peer.Offers = std::move(announcement);
    peer.OffersSince = heard.Arrival;
    peer.OffersDigest = beat.offers;
    change.Offers = true;
    _missing.LetGo(peer.Node);
}

bool PeerTable::Adopt(const Peer &elsewhere)
{
    const auto found = _peers.find(elsewhere.Node);
    if (found == _peers.end() || !elsewhere.Offers || found->second.Incarnation != elsewhere.Incarnation ||
        found->second.BeatsOffers != elsewhere.OffersDigest || found->second.HasPresentOffers())
    {
        return false;
    }
    Peer &peer = found->second;
    peer.Offers = elsewhere.Offers;
    peer.OffersDigest = elsewhere.OffersDigest;
    peer.OffersSince = elsewhere.OffersSince;
    _missing.LetGo(peer.Node);
    return true;
}

PeerTable::Change PeerTable::OnGoodbye(const HeardBeat &heard)
{
    const auto found = _peers.find(heard.Node);
    if (found != _peers.end() && found->second.Incarnation == heard.Incarnation)
    {
        // Beats that the goodbye overtook are ignored.
        found->second.LastBeatSource = std::max(found->second.LastBeatSource, Duration(heard.Beat.source_ns));
    }
    return OnLeft(heard.Node, heard.Incarnation);
}

PeerTable::Change PeerTable::OnLeft(const std::string &node, std::uint64_t incarnation)
{
    Change change;
    const auto found = _peers.find(node);
    if (found == _peers.end() || found->second.Incarnation != incarnation)
    {
        return change;
    }
    if (found->second.IsTool)
    {
        ForgetTool(found, change);
    }
    else
    {
        change.State = SetState(found->second, NodeState::LOST, "left");
    }
    return change;
}

PeerTable::Change PeerTable::Advance(Duration now)
{
    Change change;
    if (now < _nextChange)
    {
        return change;
    }
    if (_ownTwice && now - _ownTwinSince > TwinMemory)
    {
        _ownTwice = false;
        _ownTwinPlace.clear();
        change.State = true;
    }
    for (auto entry = _peers.begin(); entry != _peers.end();)
    {
        Peer &peer = entry->second;
        if (peer.IsTool)
        {
            entry = now - peer.LastHeard > peer.LostAfter() ? ForgetTool(entry, change) : std::next(entry);
            continue;
        }
        ++entry;
        if (peer.Twice && now - peer.TwinSince > TwinMemory)
        {
            peer.Twice = false;
            peer.TwinPlace.clear();
            change.State = true;
        }
        const Duration silence = now - peer.LastHeard;
        if (silence > peer.LostAfter() && peer.State != NodeState::LOST)
        {
            change.State |= SetState(peer, NodeState::LOST, NoBeatWithin(peer.LostAfter()));
        }
        else if (silence > peer.StaleAfter() && peer.State == NodeState::UP)
        {
            change.State |= SetState(peer, NodeState::STALE, NoBeatWithin(peer.StaleAfter()));
        }
    }
    _nextChange = OwnChange();
    for (const auto &[name, peer] : _peers)
    {
        Expect(peer);
    }
    return change;
}

std::optional<PeerTable::Duration> PeerTable::NextChange() const
{
    return _nextChange == Duration::max() ? std::nullopt : std::optional(_nextChange);
}

// When the name of this node has no twin any more, as Advance sees it, which compares with `>`.
PeerTable::Duration PeerTable::OwnChange() const
{
    return _ownTwice ? _ownTwinSince + TwinMemory + Duration(1) : Duration::max();
}

// Takes note of when Advance will change that peer if nothing is heard of it.
void PeerTable::Expect(const Peer &peer)
{
    constexpr Duration after(1);
    if (peer.Twice)
    {
        _nextChange = std::min(_nextChange, peer.TwinSince + TwinMemory + after);
    }
    if (peer.State != NodeState::LOST)
    {
        const bool staleIsNext = peer.State == NodeState::UP && !peer.IsTool;
        const Duration silence = staleIsNext ? peer.StaleAfter() : peer.LostAfter();
        _nextChange = std::min(_nextChange, peer.LastHeard + silence + after);
    }
}

bool PeerTable::IsEchoDue(const Peer &peer, Duration now) const
{
    return peer.State != NodeState::LOST && (!peer.LastEchoed || now - *peer.LastEchoed >= _echoPeriod);
}

bool PeerTable::IsEchoUrgent(const Peer &peer)
{
    return peer.State != NodeState::LOST && peer.DoubtsThisNode;
}

std::size_t PeerTable::EchoesDue(Duration now, std::size_t usual) const
{
    std::size_t urgent = 0;
    std::size_t due = 0;
    for (const auto &[name, peer] : _peers)
    {
        urgent += IsEchoUrgent(peer) ? 1 : 0;
        due += !IsEchoUrgent(peer) && IsEchoDue(peer, now) ? 1 : 0;
    }
    return urgent + std::min(due, usual);
}

std::vector<Gateway::BeatEcho> PeerTable::NextEchoes(Duration now, std::size_t usual, std::size_t most)
{
    std::vector<Gateway::BeatEcho> echoes;
    const auto take = [&](Peer &peer)
    {
        Gateway::BeatEcho echo;
        echo.node = peer.Tag;
        echo.beat = static_cast<std::uint32_t>(peer.LastBeatSource.count());
        echo.held_us = static_cast<std::uint32_t>(
            std::chrono::duration_cast<std::chrono::microseconds>(now - peer.LastBeatArrival).count());
        echoes.push_back(echo);
        peer.LastEchoed = now;
        peer.DoubtsThisNode = false;
        return true;
    };
    TakeTurns(_peers, _lastReassured, most,
              [&](const std::string &, Peer &peer) { return IsEchoUrgent(peer) && take(peer); });
    TakeTurns(_peers, _lastEchoed, std::min(usual, most - echoes.size()),
              [&](const std::string &, Peer &peer) { return IsEchoDue(peer, now) && take(peer); });
    return echoes;
}

}  // namespace Rabit
