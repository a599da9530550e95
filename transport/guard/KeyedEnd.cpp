#include "guard/KeyedEnd.h"

#include <limits>

#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"

namespace Rabit::Rtps
{

namespace
{

constexpr std::size_t GuidSize = 16;
constexpr std::size_t ParameterHeaderSize = 4;
constexpr std::size_t InlineQosAt = SubmessageHeaderSize + NumberInData + SequenceSize;

// The GUID of what the sample ends, from its payload; empty: it names none.
std::span<const std::uint8_t> EndedGuid(const Delivery &delivery)
{
    const std::uint16_t wanted =
        delivery.Writer == ParticipantWriter ? Parameters::ParticipantGuid : Parameters::EndpointGuid;
    std::span<const std::uint8_t> guid;
    VisitParameters(delivery.Payload,
                    [&](const ListParameter &parameter)
                    {
                        if (parameter.Id == wanted && parameter.Value.size() == GuidSize)
                        {
                            guid = parameter.Value;
                        }
                    });
    return guid;
}

bool IsToGetKeyHash(const Submessage &submessage, const Delivery &delivery)
{
    const bool isOfDiscovery = delivery.Writer == ParticipantWriter ||
                               delivery.Writer == PublicationsWriter ||
                               delivery.Writer == SubscriptionsWriter;
    constexpr std::size_t largest =
        std::numeric_limits<std::uint16_t>::max() - ParameterHeaderSize - GuidSize;
    return submessage.Kind == SubmessageKind::Data && isOfDiscovery && !delivery.Alive &&
           delivery.HasKeyPayload && delivery.KeyHash.empty() && (submessage.Flags & InlineQosFlag) != 0 &&
           submessage.Body().size() <= largest;
}

}  // namespace

std::vector<std::uint8_t> WithKeyHash(std::span<const std::uint8_t> header, const GuidPrefix &to,
                                      const Submessage &submessage, const Delivery &delivery)
{
    const auto guid =
        IsToGetKeyHash(submessage, delivery) ? EndedGuid(delivery) : std::span<const std::uint8_t>();
    if (guid.empty())
    {
        return {};
    }
    std::vector<std::uint8_t> message(header.begin(), header.end());
    AppendDestination(message, to);
    const std::size_t at = message.size();
    const std::span<const std::uint8_t> whole = submessage.Whole;
    Append(message, whole.first(InlineQosAt));
    const std::size_t parameter = message.size();
    message.resize(parameter + ParameterHeaderSize);
    Write(std::span(message).subspan(parameter, 2), Parameters::KeyHash, submessage.LittleEndian);
    Write(std::span(message).subspan(parameter + 2, 2), GuidSize, submessage.LittleEndian);
    Append(message, guid);
    Append(message, whole.subspan(InlineQosAt));
    Write(std::span(message).subspan(at + 2, 2), message.size() - at - SubmessageHeaderSize,
          submessage.LittleEndian);
    return message;
}

}  // namespace Rabit::Rtps
