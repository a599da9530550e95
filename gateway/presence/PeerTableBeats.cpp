// The beats of a known node: its state, clock, announcement and States, as they tell, and the echoes of them.
#include <algorithm>
#include <utility>

#include "names/TakeTurns.h"
#include "presence/PeerTable.h"
#include "presence/Whereabouts.h"
#include "wire/Announcements.h"
#include "wire/BeatExtensions.h"
#include "wire/BeatNews.h"

namespace Rabit
{

using Gateway::NodeState;

void PeerTable::TakeIn(Peer &peer, const HeardBeat &heard, Change &change)
{
    Measure(peer, heard);
    peer.Beats.Add(heard.Sequence);
    peer.IsReplay = BeatExtensions::IsReplay(heard.Beat);
    peer.Strains = BeatExtensions::StrainsIn(heard.Beat);
    peer.Agreement = BeatExtensions::AgreementIn(heard.Beat);
    const bool hearsHereFirst =
        BeatExtensions::IsFirstHeardHere(heard.Beat, _ownTag).value_or(peer.HearsHereFirst);
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

void PeerTable::Measure(Peer &peer, const HeardBeat &heard) const
{
    const Gateway::Beat &beat = heard.Beat;
    const Duration source(beat.source_ns);
    const Duration now = heard.Arrival;
    peer.Place = Whereabouts::In(beat, peer.Place);
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

bool PeerTable::IsEchoDue(const Peer &peer, Duration now) const
{
    return peer.State != NodeState::LOST &&
           (peer.FirstEchoesLeft > 0 || now - peer.LastEchoed >= _echoPeriod);
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
        peer.FirstEchoesLeft -= peer.FirstEchoesLeft > 0 ? 1 : 0;
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
