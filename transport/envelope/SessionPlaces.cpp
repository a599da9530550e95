#include "envelope/SessionPlaces.h"

#include <algorithm>
#include <utility>

#include "common/RtpsReader.h"
#include "guard/DiscoveryCheck.h"

namespace Rabit::Envelope
{

namespace
{

// The payload of a DATA submessage; empty if it is cut off.
std::span<const std::uint8_t> PayloadOf(const Rtps::ConstSubmessage &data)
{
    constexpr std::size_t ToInlineQosAt = 2;
    Rtps::RtpsReader body = data.Reader();
    body.Skip(ToInlineQosAt);
    const std::size_t toInlineQos = body.U16();
    body.Skip(toInlineQos);
    if ((data.Flags & Rtps::InlineQosFlag) != 0)
    {
        while (Rtps::TakeParameter(body))
        {
        }
    }
    return body.IsGood() ? body.Rest() : std::span<const std::uint8_t>();
}

// The IPv4 places at which a participant takes discovery data that are in its announcement, which is sound.
std::vector<Rtps::Place> DiscoveryPlacesIn(std::span<const std::uint8_t> payload)
{
    std::vector<Rtps::Place> places;
    Rtps::VisitParameters(
        payload,
        [&](const Rtps::ListParameter &parameter)
        {
            constexpr std::uint32_t udpV4 = 1;  // RTPS 2.3, 9.3.2
            Rtps::RtpsReader locator(parameter.Value, Rtps::IsLittleEndianList(payload));
            if (parameter.Id != Rtps::Parameters::MetatrafficUnicastLocator || locator.U32() != udpV4)
            {
                return;
            }
            Rtps::Place &place = places.emplace_back();
            place.Port = static_cast<std::uint16_t>(locator.U32());
            const auto host = parameter.Value.last(place.Host.size());
            std::copy(host.begin(), host.end(), place.Host.begin());
        });
    return places;
}

}  // namespace

void SessionPlaces::Set(SessionTag session, const Hash &certificate, std::span<const Rtps::Place> places)
{
    const auto known = _sessions.find(session);
    const auto kept = places.first(std::min(places.size(), MostOfOne));
    if (known == _sessions.end() && _sessions.size() >= Most)
    {
        return;
    }
    // The common case: the session announces the same again, and is the last one everywhere.
    if (known != _sessions.end() && std::ranges::equal(known->second, kept) &&
        std::ranges::all_of(
            kept, [&](const Rtps::Place &place) { return _holders[place].back().Session == session; }))
    {
        return;
    }
    Remove(session);
    for (const Rtps::Place &place : kept)
    {
        std::vector<Holder> &holders = _holders[place];
        std::erase_if(holders, [session](const Holder &holder) { return holder.Session == session; });
        holders.push_back({.Session = session, .Certificate = certificate});
    }
    _sessions[session].assign(kept.begin(), kept.end());
}

void SessionPlaces::Remove(SessionTag session)
{
    const auto known = _sessions.find(session);
    if (known == _sessions.end())
    {
        return;
    }
    for (const Rtps::Place &place : known->second)
    {
        const auto found = _holders.find(place);
        if (found == _holders.end())
        {
            continue;
        }
        std::erase_if(found->second, [session](const Holder &holder) { return holder.Session == session; });
        if (found->second.empty())
        {
            _holders.erase(found);
        }
    }
    _sessions.erase(known);
}

std::optional<SessionTag> SessionPlaces::At(const Rtps::Place &place) const
{
    const auto found = _holders.find(place);
    if (found == _holders.end())
    {
        return std::nullopt;
    }
    const Holder &last = found->second.back();
    const bool isAlone = std::ranges::all_of(
        found->second, [&last](const Holder &holder) { return holder.Certificate == last.Certificate; });
    return isAlone ? std::optional(last.Session) : std::nullopt;
}

std::optional<Rtps::Place> AnnouncedPlaces::DiscoveryAt(const Rtps::HostAddress &host) const
{
    const auto found =
        std::ranges::find_if(Discovery, [&host](const Rtps::Place &place) { return place.Host == host; });
    return found == Discovery.end() ? std::nullopt : std::optional(*found);
}

AnnouncedPlaces ReadAnnouncedPlaces(std::span<const std::uint8_t> message)
{
    AnnouncedPlaces places;
    const Rtps::GuidPrefix sender = Rtps::PrefixOf(message.subspan(std::min(Rtps::PrefixAt, message.size())));
    Rtps::VisitSubmessages(message,
                           [&](const Rtps::ConstSubmessage &part)
                           {
                               if (part.Kind != Rtps::SubmessageKind::Data ||
                                   Rtps::WriterOf(part) != Rtps::ParticipantWriter ||
                                   (part.Flags & Rtps::DataFlag) == 0)
                               {
                                   return;
                               }
                               // The check changes what it reads.
                               const auto payload = PayloadOf(part);
                               std::vector<std::uint8_t> copy(payload.begin(), payload.end());
                               if (auto read = Rtps::CheckDiscovery(Rtps::ParticipantWriter, sender, copy))
                               {
                                   places = {.All = std::move(read->Places),
                                             .Discovery = DiscoveryPlacesIn(payload),
                                             .HasCard = read->HasCard};
                               }
                           });
    return places;
}

}  // namespace Rabit::Envelope
