#include "common/RtpsTraffic.h"

#include <algorithm>
#include <array>

namespace Rabit
{

namespace
{

// OMG DDSI-RTPS 2.3, 9.4.5
constexpr std::size_t HeaderSize = 20;
constexpr std::size_t SubmessageHeaderSize = 4;
constexpr std::uint8_t Data = 0x15;
constexpr std::uint8_t DataFrag = 0x16;
constexpr std::uint8_t LittleEndian = 0x01;
constexpr std::uint8_t HasData = 0x04;  // of a DATA: not a key alone
constexpr std::size_t IdSize = 4;
constexpr std::size_t WriterInData = 8;
constexpr std::size_t WriterElsewhere = 4;
// 9.3.1.2: the two highest bits of an entity's last byte.
constexpr std::uint8_t Builtin = 0xc0;
constexpr std::array<std::uint8_t, IdSize> ParticipantWriter{0x00, 0x01, 0x00, 0xc2};

// ACKNACK, HEARTBEAT, GAP, NACK_FRAG, HEARTBEAT_FRAG
bool NamesWriter(std::uint8_t kind)
{
    return (kind >= 0x06 && kind <= 0x08) || kind == 0x12 || kind == 0x13;
}

struct Submessage
{
    std::uint8_t Kind = 0;
    std::uint8_t Flags = 0;
    std::span<const std::uint8_t> Writer;  // its identity; empty if it names none, or that is cut off
};

bool Names(const Submessage &submessage)
{
    return submessage.Kind == Data || submessage.Kind == DataFrag || NamesWriter(submessage.Kind);
}

// Calls visit(submessage) with each until it returns false.
template <typename Visit>
void VisitAll(std::span<const std::uint8_t> message, const Visit &visit)
{
    std::size_t at = HeaderSize;
    while (at + SubmessageHeaderSize <= message.size())
    {
        Submessage found{.Kind = message[at], .Flags = message[at + 1], .Writer = {}};
        const bool isData = found.Kind == Data || found.Kind == DataFrag;
        const std::size_t writer = at + SubmessageHeaderSize + (isData ? WriterInData : WriterElsewhere);
        if (Names(found) && writer + IdSize <= message.size())
        {
            found.Writer = message.subspan(writer, IdSize);
        }
        if (!visit(found))
        {
            return;
        }
        const std::size_t first = message[at + 2];
        const std::size_t second = message[at + 3];
        at += SubmessageHeaderSize +
              ((found.Flags & LittleEndian) != 0 ? second << 8 | first : first << 8 | second);
    }
}

bool IsOfParticipant(const Submessage &submessage)
{
    return submessage.Kind == Data && (submessage.Flags & HasData) != 0 &&
           std::equal(submessage.Writer.begin(), submessage.Writer.end(), ParticipantWriter.begin(),
                      ParticipantWriter.end());
}

}  // namespace

bool IsOfSamples(std::span<const std::uint8_t> head)
{
    bool samples = false;
    VisitAll(head,
             [&](const Submessage &submessage)
             {
                 samples = !submessage.Writer.empty() && (submessage.Writer.back() & Builtin) != Builtin;
                 return !Names(submessage);
             });
    return samples;
}

Announcing AnnouncingOf(std::span<const std::uint8_t> message)
{
    int announcements = 0;
    int others = 0;
    VisitAll(message,
             [&](const Submessage &submessage)
             {
                 announcements += IsOfParticipant(submessage) ? 1 : 0;
                 others += Names(submessage) && !IsOfParticipant(submessage) ? 1 : 0;
                 return true;
             });
    return {.Any = announcements > 0, .Alone = announcements > 0 && others == 0};
}

}  // namespace Rabit
