#include "SealStage.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "Random.h"
#include "common/RtpsWriter.h"
#include "rtps/CardMessage.h"

namespace Rabit::Simulated
{

namespace
{

using Bytes = std::vector<std::uint8_t>;

// Each participant has an address of its own.
Rtps::Place PlaceOf(ParticipantId id)
{
    constexpr std::uint16_t port = 7410;
    return {.Host = {10, static_cast<std::uint8_t>(id >> 16), static_cast<std::uint8_t>(id >> 8),
                     static_cast<std::uint8_t>(id)},
            .Port = port};
}

Bytes HeaderOf(ParticipantId self)
{
    constexpr std::array<std::uint8_t, Rtps::PrefixAt> beginning{'R', 'T', 'P', 'S', 2, 2, 'R', 's'};
    Bytes message(beginning.begin(), beginning.end());
    Rtps::Append(message, PrefixOf(self));
    return message;
}

// An announcement with no more than is needed to know where the participant is (OMG DDSI-RTPS 2.3, 9.6.3).
Bytes AnnouncementOf(ParticipantId self)
{
    constexpr std::uint64_t udpV4 = 1;
    constexpr std::uint64_t seconds = 30;
    const Rtps::Place place = PlaceOf(self);
    Bytes guid;
    Rtps::Append(guid, PrefixOf(self));
    Rtps::AppendEntity(guid, Rtps::ParticipantEntity);
    Bytes lease;
    Rtps::Append(lease, seconds, 4);
    Rtps::Append(lease, 0, 4);
    Bytes locator;
    Rtps::Append(locator, udpV4, 4);
    Rtps::Append(locator, place.Port, 4);
    locator.resize(locator.size() + 12);
    Rtps::Append(locator, place.Host);

    Bytes body{0, 0, 16, 0};  // extra flags, octetsToInlineQos
    Rtps::AppendEntity(body, 0);
    Rtps::AppendEntity(body, Rtps::ParticipantWriter);
    Rtps::AppendSequence(body, 1);
    body.insert(body.end(), {0, 3, 0, 0});  // a list of parameters, little-endian
    Rtps::AppendParameter(body, Rtps::Parameters::ParticipantGuid, guid);
    Rtps::AppendParameter(body, Rtps::Parameters::LeaseDuration, lease);
    Rtps::AppendParameter(body, Rtps::Parameters::DefaultUnicastLocator, locator);
    Rtps::AppendParameter(body, Rtps::Parameters::Sentinel, {});

    Bytes message = HeaderOf(self);
    Rtps::AppendSubmessageHeader(message, Rtps::SubmessageKind::Data, body.size(), Rtps::DataFlag);
    Rtps::Append(message, body);
    return message;
}

Bytes OtherOf(ParticipantId self)
{
    Bytes message = HeaderOf(self);
    Rtps::AppendSubmessageHeader(message, Rtps::SubmessageKind::Pad, 0);
    return message;
}

Envelope::RtpsHeader HeaderOfMessage(std::span<const std::uint8_t> message)
{
    Envelope::RtpsHeader header{};
    std::copy_n(message.begin(), header.size(), header.begin());
    return header;
}

}  // namespace

SealStage::SealStage(const std::shared_ptr<FleetMember> &member, ParticipantId self, std::uint64_t seed,
                     TimePoint now)
    : _announcement(AnnouncementOf(self)), _other(OtherOf(self))
{
    const auto fill = [random = Random(seed)](std::span<std::uint8_t> bytes) mutable
    {
        std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::uint8_t>(random.Next()); });
        return true;
    };
    const Bytes card = Rtps::WriteCardMessage({.From = PrefixOf(self)});
    _core = Envelope::SealedCore::Make(std::static_pointer_cast<Envelope::Member>(member),
                                       {HeaderOfMessage(_other), HeaderOfMessage(card)}, fill, now);
    if (_core == nullptr)
    {
        throw TransportError("OpenSSL cannot use the keys of this node", "security");
    }
}

SealStage::Sealed SealStage::Seal(const Datagram &datagram, ParticipantId to, TimePoint now)
{
    const bool isCard = datagram.What == Datagram::Kind::Card;
    const Bytes &message = isCard                                      ? *datagram.Card
                           : datagram.What == Datagram::Kind::Announce ? _announcement
                                                                       : _other;
    const std::optional<Rtps::Place> place =
        to == Nobody ? std::nullopt : std::optional<Rtps::Place>(PlaceOf(to));
    const auto contents = isCard ? Envelope::OuterClass::Meeting : Envelope::OuterClass::Traffic;
    Bytes sealed;
    if (!_core->Seal(message, place, contents, sealed, now))
    {
        return {};
    }
    const std::size_t added = sealed.size() - message.size();
    return {.Bytes = std::make_shared<const Bytes>(std::move(sealed)), .Added = added};
}

bool SealStage::Opens(const std::vector<std::uint8_t> *sealed, ParticipantId from, TimePoint now)
{
    Bytes datagram = sealed != nullptr ? *sealed : OtherOf(from);
    return !_core->Open(datagram, PlaceOf(from), now).empty();
}

std::optional<std::string> SealStage::NameOf(ParticipantId peer) const
{
    const auto bound = _core->PeerOf(PrefixOf(peer));
    return bound != nullptr ? std::optional(bound->Name) : std::nullopt;
}

bool SealStage::May(ParticipantId peer, bool write, std::string_view topic) const
{
    const auto bound = _core->PeerOf(PrefixOf(peer));
    return bound != nullptr &&
           (write ? bound->List->MayWrite(topic, bound->Role) : bound->List->MayRead(topic));
}

}  // namespace Rabit::Simulated
