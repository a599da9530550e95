#include "rtps/Meeting.h"

#include <rabit/base/Earliest.h>

#include <algorithm>
#include <utility>

#include "common/RtpsTraffic.h"
#include "rtps/PackedCard.h"

namespace Rabit::Rtps
{

void Meeting::SetSelf(const GuidPrefix &self)
{
    _self = self;
    _exchange.SetSelf(self);
    _replay.SetSelf(self);
}

bool Meeting::Sending(std::span<const std::uint8_t> datagram, TimePoint now)
{
    if (!HasRtpsHeader(datagram))
    {
        return false;
    }
    SetSelf(SenderOf(datagram));
    if (AnnouncingOf(datagram).Alone)
    {
        _own.Announced(datagram);
    }
    bool isForPrograms = true;
    if (const auto said = ReadEndpointSubmessages(datagram))
    {
        isForPrograms = false;
        for (const EndpointSubmessage &each : *said)
        {
            Say(each, datagram.first(RtpsHeaderSize), now);
            isForPrograms = IsForPrograms(each.To, now) || isForPrograms;
        }
    }
    if (_own.TakeChanged() && !_packAt)
    {
        _packAt = now + Hold;
    }
    return !isForPrograms;
}

void Meeting::Say(const EndpointSubmessage &said, std::span<const std::uint8_t> header, TimePoint now)
{
    if (said.Kind == SubmessageKind::DataFrag)
    {
        const auto whole = _fragments.Add(header, said.Said, {});
        const auto parts = whole.empty() ? std::nullopt : ReadEndpointSubmessages(whole);
        if (parts)
        {
            _own.Said(parts->front());
        }
        return;
    }
    _own.Said(said);
    _replay.Said(said, now);
}

bool Meeting::IsForPrograms(const GuidPrefix &to, TimePoint now)
{
    if (to != GuidPrefix{})
    {
        return !_replay.Has(to);
    }
    std::erase_if(_programs, [now](const auto &entry) { return now - entry.second >= ProgramsForgotten; });
    return !_programs.empty();
}

bool Meeting::IsThere(const GuidPrefix &peer, const HostAddress &from)
{
    if (_places.size() >= MostRemembered && !_places.contains(peer))
    {
        std::erase_if(_places, [this](const auto &entry) { return !_replay.Has(entry.first); });
    }
    return _places.try_emplace(peer, from).first->second.Accepts(from);
}

bool Meeting::Received(std::span<const std::uint8_t> datagram, const HostAddress &from, bool isKnownAt,
                       TimePoint now)
{
    const auto message = ReadCardMessage(datagram);
    if (!message)
    {
        return false;
    }
    if (message->From == _self || !_goodbyes.Heard(message->From, now))
    {
        return true;
    }
    // Before its card is there, nothing tells where a participant is. The card does, whoever sends it.
    // Until the guard has seen the replay it does not know either, so the card is asked.
    if (!isKnownAt && _replay.Has(message->From) && !_replay.IsAt(message->From, from) &&
        !IsThere(message->From, from))
    {
        return false;
    }
    const auto card = _exchange.Received(*message, now);
    if (!card)
    {
        _replay.GoOn(message->From, now);
        return true;
    }
    const bool isNew = !_replay.Has(card->Of);
    IsThere(card->Of, from);
    const auto unpacked = UnpackCard(card->Packed);
    if (!unpacked || !_replay.Put(card->Of, *unpacked, now))
    {
        _exchange.Refuse(card->Of, now);
        return false;
    }
    if (_programs.erase(card->Of) > 0)
    {
        _replay.EndFirst(card->Of);  // anybody can announce it as a program without a card
    }
    NoteSuccessor(card->Of);
    NoteStranger(card->Of, from, isNew);
    return true;
}

void Meeting::NoteStranger(const GuidPrefix &peer, const HostAddress &from, bool isNew)
{
    const auto found = _strangers.find(peer);
    if (!isNew && found == _strangers.end())
    {
        return;  // it has spoken
    }
    Stranger &stranger = _strangers[peer];
    stranger.Turn = found == _strangers.end() ? ++_turn : stranger.Turn;
    stranger.Host = from;
    _bytesOfStrangers -= stranger.Bytes;
    stranger.Bytes = _replay.BytesOf(peer);
    _bytesOfStrangers += stranger.Bytes;
    while (_strangers.size() > MostStrangers || _bytesOfStrangers > MostOfStrangers)
    {
        std::map<HostAddress, std::size_t> costs;
        for (const auto &[name, each] : _strangers)
        {
            costs[each.Host] += each.Bytes + MostOfStrangers / MostStrangers;
        }
        const auto dearest = std::max_element(
            costs.begin(), costs.end(), [](const auto &a, const auto &b) { return a.second < b.second; });
        const auto isOlder = [&](const auto &a, const auto &b)
        {
            const bool isOfDearest = a.second.Host == dearest->first;
            return isOfDearest != (b.second.Host == dearest->first) ? isOfDearest
                                                                    : a.second.Turn < b.second.Turn;
        };
        End(GuidPrefix(std::min_element(_strangers.begin(), _strangers.end(), isOlder)->first));
    }
}

void Meeting::Spoke(const GuidPrefix &peer)
{
    const auto found = _strangers.find(peer);
    if (found != _strangers.end())
    {
        _bytesOfStrangers -= found->second.Bytes;
        _strangers.erase(found);
    }
}

void Meeting::NoteSuccessor(const GuidPrefix &peer)
{
    const std::string name = _replay.NameOf(peer);
    _superseded.erase(peer);
    for (const GuidPrefix &other : _replay.Peers())
    {
        if (other != peer && _replay.NameOf(other) == name)
        {
            _superseded.emplace(other, name);
        }
    }
}

void Meeting::HeardUnknown(const GuidPrefix &peer, TimePoint now)
{
    if (!_goodbyes.Heard(peer, now))
    {
        return;
    }
    _replay.Has(peer) ? _replay.Again(peer, now) : _exchange.Heard(peer, now);
}

void Meeting::Announced(const GuidPrefix &peer, bool hasCard, TimePoint now)
{
    if (hasCard)
    {
        _exchange.Announced(peer, now);
    }
    else if (_programs.size() < MostRemembered)
    {
        _programs.insert_or_assign(peer, now);
    }
}

void Meeting::SaidGoodbye(const GuidPrefix &peer, TimePoint now)
{
    Lost(peer);
    _goodbyes.Note(peer, now);
}

void Meeting::Lost(const GuidPrefix &peer)
{
    _exchange.Forget(peer);
    _replay.Forget(peer);
    _places.erase(peer);
    _programs.erase(peer);
    _superseded.erase(peer);
    Spoke(peer);
}

// Packs the card with as many endpoints as it holds.
void Meeting::Pack(TimePoint now)
{
    _told.Endpoints = _own.Endpoints();
    std::size_t most = std::min(OwnCard::MostEndpoints, _own.Size());
    auto packed = PackCard(_own.Message(most));
    while (packed.empty() && most > 0)
    {
        most = most > _told.Endpoints ? _told.Endpoints : most * 7 / 8;
        packed = PackCard(_own.Message(most));
    }
    _told.InCard = std::min(most, _told.Endpoints);
    _exchange.SetOwn(std::move(packed), now);
}

std::optional<Meeting::Told> Meeting::CardIsFull() const
{
    return _told.InCard < _told.Endpoints ? std::optional(_told) : std::nullopt;
}

std::optional<Meeting::TimePoint> Meeting::LocalDue() const
{
    return Earliest({_packAt, _replay.Due()});
}

std::vector<Meeting::Local> Meeting::TakeLocal(TimePoint now)
{
    if (IsBy(_packAt, now))
    {
        _packAt.reset();
        Pack(now);
    }
    std::vector<Local> taken;
    for (CardReplay::Message &message : _replay.TakeDue(now, _own))
    {
        const auto place = _places.find(message.From);
        taken.push_back({.From = place == _places.end() ? UnknownHost : place->second.Accepted(),
                         .Bytes = std::move(message.Bytes)});
    }
    return taken;
}

std::vector<GuidPrefix> Meeting::Endable() const
{
    if (_replay.Size() > MostSilent)
    {
        return _replay.Peers();
    }
    std::vector<GuidPrefix> peers;
    for (const auto &[peer, name] : _superseded)
    {
        peers.push_back(peer);
    }
    return peers;
}

void Meeting::End(const GuidPrefix &peer)
{
    _replay.End(peer);
    Lost(peer);
    _ended.Put(peer, {});
}

}  // namespace Rabit::Rtps
