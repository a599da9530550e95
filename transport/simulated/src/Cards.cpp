// NetworkCore: participants exchange the announcements of themselves and their endpoints, by the cards of the
// real backends.
#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "NetworkCore.h"

namespace Rabit::Simulated
{

// CardExchange's clock at simulated time 0 is that of a computer that has run for a while.
Rtps::CardExchange::TimePoint NetworkCore::CardTimeOf(Time now)
{
    return Rtps::CardExchange::TimePoint(std::chrono::hours(1)) + now;
}

void NetworkCore::Await(DueTimer &timer, Event::Kind kind, ParticipantId at,
                        std::optional<Rtps::CardExchange::TimePoint> due)
{
    constexpr Time shortest = std::chrono::microseconds(100);
    const Time time = due ? _now + std::max<Time>(*due - CardTime(), shortest) : Time::max();
    if (due && (!timer.At || time < *timer.At))
    {
        timer.At = time;
        Later(time - _now, {kind, at, 0, ++timer.Number, {}});
    }
}

void NetworkCore::AwaitCards(ParticipantState &me)
{
    Await(me.CardTimer, Event::Kind::CardTimer, me.Id, me.Cards.Due());
}

void NetworkCore::ServeCards(const ParticipantPtr &me)
{
    me->CardTimer.At.reset();
    if (me->Turns.IsScheduled())
    {
        _calls.emplace_back([me] { me->Turns.Due(); });
        return;
    }
    while (SendCard(me))
    {
    }
    AwaitCards(*me);
}

bool NetworkCore::SendCard(const ParticipantPtr &me)
{
    auto outgoing = me->Cards.TakeDue(CardTime());
    if (!outgoing)
    {
        return false;
    }
    Datagram datagram;
    datagram.What = Datagram::Kind::Card;
    datagram.Card = std::make_shared<const std::vector<std::uint8_t>>(std::move(outgoing->Bytes));
    datagram.Endpoints = me->Endpoints;
    datagram.Sender = me;
    SendDiscovery(*me, outgoing->To ? ParticipantOf(*outgoing->To) : Nobody, datagram);
    return true;
}

std::size_t NetworkCore::NextDiscoveryBytes(ParticipantState &participant)
{
    const std::lock_guard lock(_mutex);
    if (participant.Gone)
    {
        return 0;
    }
    if (const std::size_t introduction = IntroductionBytes(participant); introduction > 0)
    {
        return introduction;
    }
    const std::size_t card = participant.Cards.DueBytes(CardTime());
    if (card == 0)
    {
        AwaitCards(participant);
    }
    return card;
}

void NetworkCore::SendNextDiscovery(const ParticipantPtr &participant)
{
    const std::lock_guard lock(_mutex);
    if (!participant->Gone && !SendIntroduction(participant))
    {
        SendCard(participant);
    }
}

Time NetworkCore::CardDelay(const ParticipantState &participant) const
{
    const std::lock_guard lock(_mutex);
    return participant.Cards.Delay(CardTime());
}

void NetworkCore::HearCard(const ParticipantPtr &me, ParticipantId from, const Datagram &datagram)
{
    const auto message = Rtps::ReadCardMessage(*datagram.Card);
    if (!message || me->Departed.contains(from))
    {
        return;
    }
    if (me->Cards.Received(*message, CardTime()))
    {
        if (MayMeet(*me, from, *datagram.Sender))
        {
            TakeEndpoints(me, MeetPeer(me, from, *datagram.Sender), AllowedOf(*me, from, datagram.Endpoints));
        }
        else
        {
            me->Cards.Refuse(message->From, CardTime());
        }
    }
    AwaitCards(*me);
}

// A datagram of an unknown participant is a reason to request its card.
void NetworkCore::HearUnknown(ParticipantState &me, ParticipantId from, const Datagram &datagram)
{
    const bool isOfDiscovery = datagram.What == Datagram::Kind::Announce ||
                               datagram.What == Datagram::Kind::Bye || datagram.What == Datagram::Kind::Card;
    if (!isOfDiscovery && !me.Departed.contains(from))
    {
        me.Cards.Heard(PrefixOf(from), CardTime());
        AwaitCards(me);
    }
}

}  // namespace Rabit::Simulated
