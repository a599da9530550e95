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
Rtps::CardExchange::TimePoint NetworkCore::CardTime() const
{
    return Rtps::CardExchange::TimePoint(std::chrono::hours(1)) + _now;
}

void NetworkCore::AwaitCards(ParticipantState &me)
{
    constexpr Time shortest = std::chrono::microseconds(100);
    const auto due = me.Cards.Due();
    const Time at = due ? _now + std::max<Time>(*due - CardTime(), shortest) : Time::max();
    if (due && (!me.CardsAt || at < *me.CardsAt))
    {
        me.CardsAt = at;
        Later(at - _now, {Event::Kind::CardTimer, me.Id, 0, ++me.CardTimer, {}});
    }
}

void NetworkCore::ServeCards(const ParticipantPtr &me)
{
    me->CardsAt.reset();
    for (Rtps::CardExchange::Outgoing &outgoing : me->Cards.TakeDue(CardTime()))
    {
        Datagram datagram;
        datagram.What = Datagram::Kind::Card;
        datagram.Card = std::make_shared<const std::vector<std::uint8_t>>(std::move(outgoing.Bytes));
        datagram.Endpoints = me->Endpoints;
        datagram.Sender = me;
        Letters letters;
        for (const auto &[id, other] : _participants)
        {
            const bool isFor = outgoing.To ? id == ParticipantOf(*outgoing.To) : other != me;
            if (isFor && other->Settings.Domain == me->Settings.Domain)
            {
                letters.push_back({id, datagram, _timings.DiscoveryDelay});
            }
        }
        SendTogether(*me, std::move(letters), !outgoing.To && me->Settings.Multicast);
    }
    AwaitCards(*me);
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
        TakeEndpoints(me, MeetPeer(me, from, *datagram.Sender), datagram.Endpoints);
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

void NetworkCore::SetCardRate(ParticipantState &participant, double bytesPerSecond)
{
    const std::lock_guard lock(_mutex);
    participant.Cards.SetRate(bytesPerSecond);
}

}  // namespace Rabit::Simulated
