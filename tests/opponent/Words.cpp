#include "Words.h"

#include <algorithm>

#include "common/RtpsWriter.h"
#include "rtps/CardMessage.h"
#include "rtps/PackedCard.h"

namespace Opponent
{

using namespace RtpsBytes;
using Rabit::Rtps::ParticipantEntity;
using Rabit::Rtps::ParticipantWriter;
namespace Parameters = Rabit::Rtps::Parameters;

namespace
{

constexpr std::uint8_t HasData = 5;

Bytes Locator(const Place &place)
{
    return Join({U32(1), U32(place.Port), Bytes(12), {10, 77, 0, place.Host}});
}

}  // namespace

GuidPrefix Invented(std::uint64_t number)
{
    GuidPrefix name{1, 15, 0x66};
    for (std::size_t i = 0; i < sizeof number; ++i)
    {
        name[4 + i] = static_cast<std::uint8_t>(number >> (8 * i));
    }
    return name;
}

Bytes ParticipantData(const GuidPrefix &name, const Place &place)
{
    return List({Parameter(Parameters::ProtocolVersion, {2, 3, 0, 0}),
                 Parameter(Parameters::VendorId, {1, 15, 0, 0}),
                 Parameter(Parameters::ParticipantGuid, Guid(name, ParticipantEntity)),
                 Parameter(Parameters::LeaseDuration, Join({U32(300), U32(0)})),
                 Parameter(Parameters::BuiltinEndpointSet, U32(0x0c3f)),
                 Parameter(Parameters::MetatrafficUnicastLocator, Locator(place)),
                 Parameter(Parameters::DefaultUnicastLocator, Locator(place)),
                 Parameter(Parameters::EntityName, Text("uav7"))});
}

Bytes EndpointData(const GuidPrefix &name, EntityId entity, const char *topic, const char *type,
                   std::size_t userData)
{
    const Bytes data = Join({U32(static_cast<std::uint32_t>(userData)), Bytes(userData)});
    return List({Parameter(Parameters::EndpointGuid, Guid(name, entity)),
                 Parameter(Parameters::TopicName, Text(topic)), Parameter(Parameters::TypeName, Text(type)),
                 Parameter(Parameters::UserData, data)});
}

Bytes ParticipantSaid(const GuidPrefix &name, const Place &place, std::int64_t number)
{
    return Submessage(Data, DataBody(number, ParticipantData(name, place), ParticipantWriter), HasData);
}

Bytes EndpointSaid(EntityId writer, const Bytes &data, std::int64_t number)
{
    return Submessage(Data, DataBody(number, data, writer), HasData);
}

Bytes Announcement(const GuidPrefix &name, const Place &place, std::int64_t number)
{
    return Join({Header(name), ParticipantSaid(name, place, number)});
}

Bytes Goodbye(const GuidPrefix &name, std::int64_t number)
{
    Bytes message = Header(name);
    const Bytes key = List({Parameter(Parameters::ParticipantGuid, Guid(name, ParticipantEntity))});
    const Bytes qos = Join({Parameter(Parameters::StatusInfo, {0, 0, 0, 3}), U32(1)});
    constexpr std::uint8_t inlineQosAndKey = 0x0b;
    return Join(
        {message, Submessage(Data, DataBody(number, Join({qos, key}), ParticipantWriter), inlineQosAndKey)});
}

Bytes Heartbeat(const GuidPrefix &name, EntityId writer, std::int64_t first, std::int64_t last,
                std::uint32_t count)
{
    return Join({Header(name), Submessage(RtpsBytes::Heartbeat, HeartbeatBody(first, last, count, writer))});
}

std::vector<Bytes> CardOf(const GuidPrefix &name, std::initializer_list<Bytes> submessages, TimePoint now)
{
    using namespace Rabit::Rtps;
    const Bytes packed = PackCard(Join({Header(name), Join(submessages)}));
    CardMessage message{.From = name, .Summary = SummaryOf(packed)};
    message.SentAt = static_cast<std::uint32_t>(
        std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count());
    message.HasPart = true;
    std::vector<Bytes> messages;
    for (std::size_t part = 0; part < message.Summary.Parts(); ++part)
    {
        message.Part = part;
        const std::size_t at = part * CardPartSize;
        message.Bytes = std::span(packed).subspan(at, std::min(CardPartSize, packed.size() - at));
        messages.push_back(WriteCardMessage(message));
    }
    return messages;
}

}  // namespace Opponent
