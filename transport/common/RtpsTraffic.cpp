#include "common/RtpsTraffic.h"

#include <utility>

#include "common/RtpsReader.h"

namespace Rabit
{

namespace
{

using Rtps::ConstSubmessage;
using Rtps::SubmessageKind;

bool IsOfParticipant(const ConstSubmessage &submessage)
{
    return submessage.Kind == SubmessageKind::Data && (submessage.Flags & Rtps::DataFlag) != 0 &&
           WriterOf(submessage) == Rtps::ParticipantWriter;
}

}  // namespace

bool IsOfSamples(std::span<const std::uint8_t> head)
{
    bool named = false;
    bool samples = false;
    Rtps::VisitSubmessages(head,
                           [&](const ConstSubmessage &submessage)
                           {
                               if (!std::exchange(named, named || Rtps::IsDelivery(submessage.Kind)) && named)
                               {
                                   const auto writer = WriterOf(submessage);
                                   samples = writer && !Rtps::IsBuiltin(*writer);
                               }
                           });
    return samples;
}

Announcing AnnouncingOf(std::span<const std::uint8_t> message)
{
    int announcements = 0;
    int others = 0;
    Rtps::VisitSubmessages(message,
                           [&](const ConstSubmessage &submessage)
                           {
                               announcements += IsOfParticipant(submessage) ? 1 : 0;
                               others +=
                                   Rtps::IsDelivery(submessage.Kind) && !IsOfParticipant(submessage) ? 1 : 0;
                           });
    return {.Any = announcements > 0, .Alone = announcements > 0 && others == 0};
}

Rtps::GuidPrefix DestinationOf(std::span<const std::uint8_t> message)
{
    Rtps::GuidPrefix to{};
    Rtps::VisitSubmessages(
        message,
        [&to](const ConstSubmessage &submessage)
        {
            if (submessage.Kind == SubmessageKind::InfoDestination && to == Rtps::GuidPrefix{})
            {
                to = Rtps::PrefixOf(submessage.Body());
            }
        });
    return to;
}

}  // namespace Rabit
