#include "guard/PlainCheck.h"

#include <algorithm>
#include <vector>

#include "guard/DiscoveryCheck.h"
#include "guard/TokenCheck.h"

namespace Rabit::Rtps
{

namespace
{

// Submessages that Cyclone DDS sends unprotected even where all else is protected: its liveliness, and the
// state of those builtin writers whose samples go by a protected counterpart (0xff...) then.
bool IsOfIdleWriter(const Submessage &submessage, const Delivery &delivery)
{
    constexpr std::int64_t Most = 65536;  // one in some seconds: days
    const bool is = submessage.Kind == SubmessageKind::Heartbeat ||
                    submessage.Kind == SubmessageKind::AckNack ||
                    (submessage.Kind == SubmessageKind::Data && delivery.Writer == LivelinessWriter);
    return is && IsKnownBuiltin(delivery.Writer) && delivery.First <= Most && delivery.Last <= Most;
}

}  // namespace

bool IsOfTypes(EntityId writer)
{
    constexpr EntityId TypeRequestsWriter = 0x000300c3;
    constexpr EntityId TypeRepliesWriter = 0x000301c3;
    return writer == TypeRequestsWriter || writer == TypeRepliesWriter;
}

bool IsHeardInPlain(const Submessage &submessage, const Delivery &delivery)
{
    return delivery.Writer == HandshakeWriter || delivery.Writer == ParticipantWriter ||
           IsOfIdleWriter(submessage, delivery);
}

bool EndsItsOwn(const Delivery &delivery, const GuidPrefix &sender)
{
    return (delivery.KeyHash.empty() || IsKeyOf(delivery.Writer, sender, delivery.KeyHash)) &&
           (!delivery.HasKeyPayload || CheckKey(delivery.Writer, sender, delivery.Payload));
}

EntityId EndedBy(const Delivery &delivery)
{
    EntityId subject = delivery.KeyHash.empty() ? 0 : EntityOf(delivery.KeyHash);
    if (subject == 0 && delivery.HasKeyPayload)
    {
        VisitParameters(delivery.Payload,
                        [&subject](const ListParameter &parameter)
                        {
                            if (parameter.Id == Parameters::EndpointGuid && parameter.Value.size() == 16)
                            {
                                subject = EntityOf(parameter.Value);
                            }
                        });
    }
    return subject;
}

bool IsSoundUnchanged(const Submessage &submessage, Delivery delivery, const GuidPrefix &sender)
{
    if (submessage.Kind != SubmessageKind::Data)
    {
        return submessage.Kind != SubmessageKind::DataFrag;
    }
    const auto payload = delivery.Payload;
    if (delivery.Writer == HandshakeWriter)
    {
        return delivery.Alive && IsGenericMessage(payload);
    }
    std::vector<std::uint8_t> copy(payload.begin(), payload.end());
    delivery.Payload = copy;
    return EndsItsOwn(delivery, sender) &&
           (delivery.HasKeyPayload || copy.empty() ||
            CheckDiscovery(delivery.Writer, sender, copy, true).has_value()) &&
           std::equal(copy.begin(), copy.end(), payload.begin());
}

}  // namespace Rabit::Rtps
