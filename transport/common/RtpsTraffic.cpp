#include "common/RtpsTraffic.h"

#include <algorithm>
#include <utility>

#include "common/RtpsSubmessages.h"

namespace Rabit
{

namespace
{

// OMG DDSI-RTPS 2.3, 9.4.5
constexpr std::uint8_t Data = 0x15;
constexpr std::uint8_t DataFrag = 0x16;
constexpr std::uint8_t HasData = 0x04;  // set in a DATA that carries more than a key
constexpr std::size_t IdSize = ParticipantWriterId.size();
constexpr std::size_t WriterInData = 8;
constexpr std::size_t WriterElsewhere = 4;
// 9.3.1.2: the two highest bits of an entity's last byte.
constexpr std::uint8_t Builtin = 0xc0;

using Submessage = RtpsSubmessage<const std::uint8_t>;

// ACKNACK, HEARTBEAT, GAP, NACK_FRAG, HEARTBEAT_FRAG
bool NamesWriter(std::uint8_t kind)
{
    return (kind >= 0x06 && kind <= 0x08) || kind == 0x12 || kind == 0x13;
}

bool Names(const Submessage &submessage)
{
    return submessage.Kind == Data || submessage.Kind == DataFrag || NamesWriter(submessage.Kind);
}

// The identity of the writer that the submessage names; empty if it is cut off.
std::span<const std::uint8_t> WriterOf(const Submessage &submessage)
{
    const bool isData = submessage.Kind == Data || submessage.Kind == DataFrag;
    const std::size_t at = isData ? WriterInData : WriterElsewhere;
    return at + IdSize <= submessage.Body().size() ? submessage.Body().subspan(at, IdSize)
                                                   : std::span<const std::uint8_t>();
}

bool IsOfParticipant(const Submessage &submessage)
{
    const auto writer = WriterOf(submessage);
    return submessage.Kind == Data && (submessage.Flags & HasData) != 0 &&
           std::equal(writer.begin(), writer.end(), ParticipantWriterId.begin(), ParticipantWriterId.end());
}

}  // namespace

bool IsOfSamples(std::span<const std::uint8_t> head)
{
    bool named = false;
    bool samples = false;
    VisitSubmessages(head,
                     [&](const Submessage &submessage)
                     {
                         if (!std::exchange(named, named || Names(submessage)) && named)
                         {
                             const auto writer = WriterOf(submessage);
                             samples = !writer.empty() && (writer.back() & Builtin) != Builtin;
                         }
                     });
    return samples;
}

Announcing AnnouncingOf(std::span<const std::uint8_t> message)
{
    int announcements = 0;
    int others = 0;
    VisitSubmessages(message,
                     [&](const Submessage &submessage)
                     {
                         announcements += IsOfParticipant(submessage) ? 1 : 0;
                         others += Names(submessage) && !IsOfParticipant(submessage) ? 1 : 0;
                     });
    return {.Any = announcements > 0, .Alone = announcements > 0 && others == 0};
}

}  // namespace Rabit
