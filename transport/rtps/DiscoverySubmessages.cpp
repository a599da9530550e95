#include "rtps/DiscoverySubmessages.h"

#include <rabit/base/Fnv1a.h>

#include <algorithm>
#include <array>

#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"
#include "guard/DiscoveryCheck.h"

namespace Rabit::Rtps
{

namespace
{

constexpr std::uint32_t MostBits = 256;

// Wraps bytes for CheckDelivery, which does not write to them.
Submessage ToBeRead(std::span<const std::uint8_t> whole)
{
    return {.Kind = SubmessageKind{whole[0]},
            .Flags = whole[1],
            .LittleEndian = (whole[1] & LittleEndianFlag) != 0,
            .Whole = {const_cast<std::uint8_t *>(whole.data()), whole.size()}};
}

// 9.4.5.4: from the first number up to the base, and those whose bits are set after it.
std::vector<std::int64_t> NumbersOfGap(const Submessage &gap, const Delivery &said)
{
    RtpsReader body = gap.Reader();
    body.Skip(8 + SequenceSize);  // entities, first number
    const std::int64_t base = body.Sequence();
    std::vector<std::int64_t> numbers;
    for (std::int64_t number = said.First; number < base; ++number)
    {
        numbers.push_back(number);
    }
    const std::uint32_t bits = body.U32();
    for (std::uint32_t bit = 0, word = 0; bit < bits && body.IsGood(); ++bit)
    {
        word = bit % 32 == 0 ? body.U32() : word << 1;
        if ((word & 0x80000000u) != 0)
        {
            numbers.push_back(base + bit);
        }
    }
    return numbers;
}

// Returns false if the submessage is of another kind.
bool Read(const Submessage &submessage, EndpointSubmessage &read)
{
    const auto delivery = CheckDelivery(submessage);
    if (!delivery || !IsEndpointWriter(delivery->Writer))
    {
        return false;
    }
    read.Kind = submessage.Kind;
    read.Said = *delivery;
    read.Whole = submessage.Whole;
    read.IsFinal = (submessage.Flags & FinalFlag) != 0;
    if (submessage.Kind == SubmessageKind::Gap)
    {
        read.Gone = NumbersOfGap(submessage, *delivery);
    }
    return true;
}

// The GUID in a parameter list that names the subject; empty if there is none.
std::span<const std::uint8_t> GuidIn(std::span<const std::uint8_t> payload)
{
    std::span<const std::uint8_t> guid;
    VisitParameters(payload,
                    [&guid](const ListParameter &parameter)
                    {
                        const bool isGuid =
                            parameter.Id == Parameters::EndpointGuid || parameter.Id == Parameters::KeyHash;
                        guid = isGuid && parameter.Value.size() == 16 ? parameter.Value : guid;
                    });
    return guid;
}

// Reader and writer.
void AppendEntities(std::vector<std::uint8_t> &message, EntityId writer)
{
    AppendEntity(message, ReaderOf(writer));
    AppendEntity(message, writer);
}

}  // namespace

EntityId ReaderOf(EntityId builtinWriter)
{
    constexpr EntityId writerToReader = 0x05;  // 0xc2 to 0xc7
    return builtinWriter ^ writerToReader;
}

bool IsEndpointWriter(EntityId writer)
{
    return writer == PublicationsWriter || writer == SubscriptionsWriter;
}

std::optional<std::vector<EndpointSubmessage>> ReadEndpointSubmessages(std::span<const std::uint8_t> datagram)
{
    std::vector<EndpointSubmessage> found;
    bool all = datagram.size() > RtpsHeaderSize;
    GuidPrefix to{};
    VisitSubmessages(datagram,
                     [&](const ConstSubmessage &part)
                     {
                         const Submessage submessage = ToBeRead(part.Whole);
                         if (submessage.Kind == SubmessageKind::Pad ||
                             submessage.Kind == SubmessageKind::InfoTimestamp || !all)
                         {
                             return;
                         }
                         if (submessage.Kind == SubmessageKind::InfoDestination)
                         {
                             all = submessage.Body().size() == to.size();
                             to = all ? PrefixOf(submessage.Body()) : to;
                             return;
                         }
                         EndpointSubmessage read{.To = to};
                         all = Read(submessage, read);
                         found.push_back(std::move(read));
                     });
    return all && !found.empty() ? std::optional(std::move(found)) : std::nullopt;
}

std::optional<Delivery> ReadAnnouncement(std::span<const std::uint8_t> submessage)
{
    const Submessage read = ToBeRead(submessage);
    return read.Kind == SubmessageKind::Data ? CheckDelivery(read) : std::nullopt;
}

EntityId SubjectOf(std::span<const std::uint8_t> announcement)
{
    const auto delivery = CheckDelivery(ToBeRead(announcement));
    if (!delivery)
    {
        return 0;
    }
    const auto guid = delivery->KeyHash.empty() ? GuidIn(delivery->Payload) : delivery->KeyHash;
    return guid.empty() ? 0 : EntityOf(guid);
}

std::uint64_t ContentOf(std::span<const std::uint8_t> announcement)
{
    constexpr std::size_t from = SubmessageHeaderSize + NumberInData + SequenceSize;
    return Fnv1a()
        .AddByte(announcement[1])
        .Add(announcement.subspan(std::min(from, announcement.size())))
        .Sum();
}

void AppendAnnouncement(std::vector<std::uint8_t> &message, std::span<const std::uint8_t> announcement,
                        std::int64_t number)
{
    const std::size_t at = message.size();
    Append(message, announcement);
    message.resize((message.size() + 3) / 4 * 4);
    const bool littleEndian = (announcement[1] & LittleEndianFlag) != 0;
    const std::span<std::uint8_t> whole = std::span(message).subspan(at);
    const auto body = whole.subspan(SubmessageHeaderSize);
    Write(whole.subspan(2, 2), body.size(), littleEndian);
    Write(body.subspan(ReaderInData, sizeof(EntityId)), 0, littleEndian);
    WriteSequence(body.subspan(NumberInData), number, littleEndian);
}

void AppendHeartbeat(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t last,
                     std::uint32_t count)
{
    AppendSubmessageHeader(message, SubmessageKind::Heartbeat, 28);
    AppendEntities(message, writer);
    AppendSequence(message, 1);
    AppendSequence(message, last);
    Append(message, count, 4);
}

void AppendGap(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t first, std::int64_t end)
{
    AppendSubmessageHeader(message, SubmessageKind::Gap, 28);
    AppendEntities(message, writer);
    AppendSequence(message, first);
    AppendSequence(message, end);
    Append(message, 0, 4);  // no further ones
}

void AppendAcknowledgement(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t base,
                           std::span<const std::int64_t> missing, std::uint32_t count)
{
    std::array<std::uint32_t, MostBits / 32> bitmap{};
    std::uint32_t bits = 0;
    for (const std::int64_t number : missing)
    {
        const std::int64_t at = number - base;
        if (at >= 0 && at < MostBits)
        {
            bitmap[static_cast<std::size_t>(at / 32)] |= 1u << (31 - at % 32);
            bits = std::max(bits, static_cast<std::uint32_t>(at + 1));
        }
    }
    const std::size_t words = (bits + 31) / 32;
    AppendSubmessageHeader(message, SubmessageKind::AckNack, 24 + 4 * words, FinalFlag);
    AppendEntities(message, writer);
    AppendSequence(message, base);
    Append(message, bits, 4);
    for (std::size_t i = 0; i < words; ++i)
    {
        Append(message, bitmap[i], 4);
    }
    Append(message, count, 4);
}

void AppendEnd(std::vector<std::uint8_t> &message, EntityId writer, const GuidPrefix &participant,
               EntityId entity, std::int64_t number)
{
    // Octets to the inline QoS, entities, number; key hash, status, end of the list; the key.
    constexpr std::uint8_t disposedAndUnregistered = 0x03;
    constexpr std::size_t guidSize = 16;
    constexpr std::size_t inlineSize = 4 + guidSize + 8 + 4;
    constexpr std::size_t keySize = 4 + 4 + guidSize + 4;
    AppendSubmessageHeader(message, SubmessageKind::Data, 20 + inlineSize + keySize, InlineQosFlag | KeyFlag);
    Append(message, 0, 2);
    Append(message, 16, 2);
    AppendEntities(message, writer);
    AppendSequence(message, number);
    std::vector<std::uint8_t> guid(participant.begin(), participant.end());
    AppendEntity(guid, entity);
    AppendParameter(message, Parameters::KeyHash, guid);
    AppendParameter(message, Parameters::StatusInfo,
                    std::to_array<std::uint8_t>({0, 0, 0, disposedAndUnregistered}));
    AppendParameter(message, Parameters::Sentinel, {});
    message.insert(message.end(), {0, 3, 0, 0});
    AppendParameter(
        message, writer == ParticipantWriter ? Parameters::ParticipantGuid : Parameters::EndpointGuid, guid);
    AppendParameter(message, Parameters::Sentinel, {});
}

}  // namespace Rabit::Rtps
