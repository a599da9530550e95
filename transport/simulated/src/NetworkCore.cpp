#include "NetworkCore.h"

#include <algorithm>
#include <utility>

#include "SealStage.h"

namespace Rabit::Simulated
{

void NetworkCore::SetFaults(const std::string &from, const std::string &to, const SimulatedFaults &faults)
{
    const std::lock_guard lock(_mutex);
    _faults.Set(from, to, faults);
}

void NetworkCore::ClearFaults()
{
    const std::lock_guard lock(_mutex);
    _faults.Clear();
}

void NetworkCore::SetMedium(const std::string &nodes, const SimulatedMedium &medium)
{
    const std::lock_guard lock(_mutex);
    _media.Set(nodes, medium);
}

SimulatedAir NetworkCore::Air(const std::string &nodes) const
{
    const std::lock_guard lock(_mutex);
    return _media.AirOf(nodes);
}

SimulatedSent NetworkCore::Sent(const std::string &node) const
{
    const std::lock_guard lock(_mutex);
    const auto number = _faults.Find(node);
    if (!number)
    {
        return {};
    }
    SimulatedSent sent = _sent[*number];
    const Medium *medium = _media.Of(*number);
    sent.WaitingBytes = medium == nullptr ? 0 : medium->WaitingBytes(*number);
    return sent;
}

Time NetworkCore::Now() const
{
    const std::lock_guard lock(_mutex);
    return _now;
}

std::optional<Time> NetworkCore::NextEvent() const
{
    const std::lock_guard lock(_mutex);
    if (_events.IsEmpty())
    {
        return std::nullopt;
    }
    return std::max(_now, _events.NextTime());
}

SimulatedTraffic NetworkCore::Traffic() const
{
    const std::lock_guard lock(_mutex);
    return _traffic;
}

void NetworkCore::AdvanceTo(Time time)
{
    const std::lock_guard stepping(_stepping);
    std::unique_lock lock(_mutex);
    while (!_events.IsEmpty() && _events.NextTime() <= time)
    {
        Reach(_events.NextTime());
        ++_traffic.Events;
        Handle(_events.Pop());
        RunCalls(lock);
    }
    Reach(time);
}

void NetworkCore::Reach(Time time)
{
    _now = std::max(_now, time);
    _shown->store(_now.count());
}

std::function<Rtps::CardExchange::TimePoint()> NetworkCore::ClockOfMembers() const
{
    return [shown = _shown] { return CardTimeOf(Time(shown->load())); };
}

void NetworkCore::RunCalls(std::unique_lock<std::mutex> &lock)
{
    if (_calls.empty())
    {
        return;
    }
    const Calls calls = std::exchange(_calls, {});
    lock.unlock();
    for (const auto &call : calls)
    {
        call();
    }
    lock.lock();
}

ParticipantPtr NetworkCore::Join(const TransportSettings &settings, PeerHandler onPeer)
{
    const auto participant = std::make_shared<ParticipantState>(settings, std::move(onPeer));
    const std::lock_guard lock(_mutex);
    participant->Id = ++_lastParticipant;
    participant->NodeNumber = _faults.NumberOf(settings.Node);
    if (participant->NodeNumber == _sent.size())
    {
        _media.AddNode(settings.Node);
        _sent.emplace_back();
    }
    if (settings.Member != nullptr)
    {
        participant->Seal =
            std::make_shared<SealStage>(settings.Member, participant->Id, _random.Next(), CardTime());
        AwaitSeal(*participant);
    }
    _participants.emplace(participant->Id, participant);
    participant->Cards.SetSelf(PrefixOf(participant->Id));
    Announce(participant);
    EndpointsChanged(*participant, nullptr, {});
    return participant;
}

void NetworkCore::Leave(ParticipantState &participant)
{
    const std::lock_guard lock(_mutex);
    if (participant.Gone)
    {
        return;
    }
    participant.Gone = true;
    _participants.erase(participant.Id);
    // To all: a peer may know this participant before it is known here.
    Letters goodbyes;
    for (const auto &[id, other] : _participants)
    {
        if (other->Settings.Domain == participant.Settings.Domain)
        {
            Datagram bye;
            bye.What = Datagram::Kind::Bye;
            goodbyes.push_back({id, std::move(bye)});
        }
    }
    SendTogether(participant, std::move(goodbyes), participant.Settings.Multicast);
}

void NetworkCore::CrashNode(const std::string &node)
{
    const std::lock_guard lock(_mutex);
    std::erase_if(_participants,
                  [&](const auto &entry)
                  {
                      ParticipantState &participant = *entry.second;
                      participant.Gone = participant.Settings.Node == node;
                      return participant.Gone;
                  });
}

void NetworkCore::Handle(Event event)
{
    if (event.What == Event::Kind::Passage)
    {
        OnPassage(_media.ByNumber(event.At));
        return;
    }
    const auto found = _participants.find(event.At);
    if (found == _participants.end())
    {
        return;  // it closed or crashed meanwhile
    }
    const ParticipantPtr at = found->second;
    switch (event.What)
    {
        case Event::Kind::Arrival:
            Arrive(at, event.Other, event.Content);
            break;
        case Event::Kind::AnnouncementTimer:
            Announce(at);
            break;
        case Event::Kind::CardTimer:
            if (event.Birth == at->CardTimer.Number)
            {
                ServeCards(at);
            }
            break;
        case Event::Kind::SealTimer:
            if (event.Birth == at->SealTimer.Number)
            {
                ServeSeal(at);
            }
            break;
        case Event::Kind::LeaseTimer:
            CheckLease(at, event.Other, event.Birth);
            break;
        case Event::Kind::HeartbeatTimer:
            if (const auto writer = at->Writers.find(event.Content.Writer);
                writer != at->Writers.end() && writer->second->HeartbeatTimer == event.Birth)
            {
                SendHeartbeats(*at, *writer->second);
            }
            break;
        case Event::Kind::Passage:
            break;
    }
}

void NetworkCore::Arrive(const ParticipantPtr &at, ParticipantId from, const Datagram &datagram)
{
    if (!Opens(*at, from, datagram) || datagram.What == Datagram::Kind::Introduction)
    {
        return;
    }
    const auto known = at->Peers.find(from);
    if (known != at->Peers.end())
    {
        known->second.LastHeard = _now;
    }
    else
    {
        HearUnknown(*at, from, datagram);
    }
    const auto reader = at->Readers.find(datagram.Reader);
    const auto writer = at->Writers.find(datagram.Writer);
    switch (datagram.What)
    {
        case Datagram::Kind::Announce:
            HearAnnouncement(at, from);
            return;
        case Datagram::Kind::Bye:
            at->Departed.insert(from);
            LosePeer(at, from, PeerEvent::Kind::Left);
            return;
        case Datagram::Kind::Card:
            HearCard(at, from, datagram);
            return;
        case Datagram::Kind::Introduction:
            return;
        case Datagram::Kind::Data:
            if (reader != at->Readers.end())
            {
                HearSample(at, reader->second, datagram);
            }
            return;
        case Datagram::Kind::Heartbeat:
            if (reader != at->Readers.end())
            {
                HearHeartbeat(at, reader->second, datagram);
            }
            return;
        case Datagram::Kind::Acknowledgement:
            if (writer != at->Writers.end())
            {
                HearAcknowledgement(*at, *writer->second, datagram);
            }
            return;
    }
}

}  // namespace Rabit::Simulated
