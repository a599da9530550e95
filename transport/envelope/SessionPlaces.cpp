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

std::vector<Rtps::Place> AnnouncedPlaces(std::span<const std::uint8_t> message)
{
    std::vector<Rtps::Place> places;
    const Rtps::GuidPrefix sender = Rtps::PrefixOf(message.subspan(std::min(Rtps::PrefixAt, message.size())));
    Rtps::VisitSubmessages(
        message,
        [&](const Rtps::ConstSubmessage &part)
        {
            if (part.Kind != Rtps::SubmessageKind::Data || Rtps::WriterOf(part) != Rtps::ParticipantWriter ||
                (part.Flags & Rtps::DataFlag) == 0)
            {
                return;
            }
            // The check changes what it reads.
            const auto payload = PayloadOf(part);
            std::vector<std::uint8_t> copy(payload.begin(), payload.end());
            if (auto read = Rtps::CheckDiscovery(Rtps::ParticipantWriter, sender, copy, false))
            {
                places = std::move(read->Places);
            }
        });
    return places;
}

}  // namespace Rabit::Envelope
