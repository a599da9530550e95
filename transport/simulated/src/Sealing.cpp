// NetworkCore: the datagrams of participants with keys.
#include <rabit/base/Earliest.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "NetworkCore.h"
#include "SealStage.h"

namespace Rabit::Simulated
{

std::uint64_t NetworkCore::SealLetters(const ParticipantState &from, Letters::iterator first,
                                       Letters::iterator last, bool multicast) const
{
    std::uint64_t added = 0;
    for (auto letter = first; from.Seal != nullptr && letter != last; ++letter)
    {
        Datagram &content = letter->Content;
        if (content.What != Datagram::Kind::Introduction)
        {
            auto sealed = from.Seal->Seal(content, multicast ? Nobody : letter->To, CardTime());
            content.Sealed = std::move(sealed.Bytes);
            added = std::max<std::uint64_t>(added, sealed.Added);
        }
    }
    return added;
}

std::uint64_t NetworkCore::SealOfPart(const ParticipantState &from)
{
    return from.Seal != nullptr ? SealStage::AddedForGroup : 0;
}

std::size_t NetworkCore::MostOfSeal(const ParticipantState &participant)
{
    return participant.Seal != nullptr ? Envelope::Sealer::MostAdded : 0;
}

bool NetworkCore::Opens(ParticipantState &at, ParticipantId from, const Datagram &datagram)
{
    if (at.Seal == nullptr)
    {
        return datagram.Sealed == nullptr;
    }
    const bool opens = at.Seal->Opens(datagram.Sealed.get(), from, CardTime());
    AwaitSeal(at);
    return opens;
}

void NetworkCore::AwaitSeal(ParticipantState &me)
{
    const bool waitsForTurn = me.Turns.IsScheduled() && me.Turns.IsDue();
    Await(me.SealTimer, Event::Kind::SealTimer, me.Id,
          Earliest({me.Seal->LocalDue(), waitsForTurn ? std::nullopt : me.Seal->NetworkDue()}));
}

void NetworkCore::ServeSeal(const ParticipantPtr &me)
{
    me->SealTimer.At.reset();
    me->Seal->Learn();
    for (std::string &line : me->Seal->TakeLogs())
    {
        _calls.emplace_back([me, line = std::move(line)] { me->Log->Line(line); });
    }
    if (me->Turns.IsScheduled() && IsBy(me->Seal->NetworkDue(), CardTime()))
    {
        _calls.emplace_back([me] { me->Turns.Due(); });
        return;
    }
    while (!me->Turns.IsScheduled() && SendIntroduction(me))
    {
    }
    AwaitSeal(*me);
}

bool NetworkCore::SendIntroduction(const ParticipantPtr &me)
{
    auto outgoing = me->Seal != nullptr ? me->Seal->TakeDue(CardTime()) : std::nullopt;
    if (!outgoing)
    {
        return false;
    }
    Datagram datagram;
    datagram.What = Datagram::Kind::Introduction;
    datagram.Sealed = std::make_shared<const std::vector<std::uint8_t>>(std::move(*outgoing));
    SendDiscovery(*me, Nobody, datagram);
    return true;
}

std::size_t NetworkCore::IntroductionBytes(ParticipantState &me)
{
    const std::size_t bytes = me.Seal != nullptr ? me.Seal->DueBytes(CardTime()) : 0;
    if (me.Seal != nullptr && bytes == 0)
    {
        AwaitSeal(me);
    }
    return bytes;
}

bool NetworkCore::MayMeet(const ParticipantState &me, ParticipantId from, const ParticipantState &sender)
{
    return me.Seal == nullptr || me.Seal->NameOf(from) == sender.Who->Node;
}

std::shared_ptr<const EndpointList> NetworkCore::AllowedOf(const ParticipantState &me, ParticipantId from,
                                                           const std::shared_ptr<const EndpointList> &all)
{
    if (me.Seal == nullptr)
    {
        return all;
    }
    auto allowed = std::make_shared<EndpointList>();
    std::copy_if(all->begin(), all->end(), std::back_inserter(*allowed),
                 [&](const EndpointInfoPtr &endpoint)
                 { return me.Seal->May(from, endpoint->IsWriter, endpoint->Topic); });
    return allowed;
}

}  // namespace Rabit::Simulated
