#include "presence/PeerTable.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <utility>

#include "names/NodeTag.h"
#include "presence/Whereabouts.h"
#include "wire/BeatExtensions.h"

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
    made.LostStated = _lostAfter;
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
    peer.FirstEchoesLeft = peer.IsTool ? EchoesToTool : 1;
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
    peer.TwinPlace = Whereabouts::In(heard.Beat, peer.TwinPlace);
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
        _ownTwinPlace = Whereabouts::In(heard.Beat, _ownTwinPlace);
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
        change.State = SetState(found->second, NodeState::LOST, Left);
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

}  // namespace Rabit
