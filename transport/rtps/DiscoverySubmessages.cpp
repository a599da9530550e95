#include "rtps/DiscoverySubmessages.h"

#include <rabit/base/Fnv1a.h>

#include <algorithm>
#include <array>

#include "guard/DiscoveryCheck.h"
#include "guard/RtpsReader.h"

namespace Rabit::Rtps
{

namespace
{

// RTPS 2.3, 9.4.5
constexpr std::uint8_t LittleEndian = 0x01;
constexpr std::uint8_t Final = 0x02;      // of HEARTBEAT and ACKNACK
constexpr std::uint8_t InlineQos = 0x02;  // of DATA
constexpr std::uint8_t KeyPayload = 0x08;
constexpr std::size_t ReaderInData = 4;
constexpr std::size_t NumberInData = 12;
constexpr std::size_t NumberSize = 8;
constexpr std::uint32_t MostBits = 256;
// 9.6.3: parameters
constexpr std::uint16_t Sentinel = 0x0001;
constexpr std::uint16_t ParticipantGuid = 0x0050;
constexpr std::uint16_t EndpointGuid = 0x005a;
constexpr std::uint16_t KeyHashParameter = 0x0070;
constexpr std::uint16_t StatusInfo = 0x0071;

void Append(std::vector<std::uint8_t> &bytes, std::uint64_t number, std::size_t size)
{
    for (std::size_t i = 0; i < size; ++i)
    {
        bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
    }
}

void AppendEntity(std::vector<std::uint8_t> &bytes, EntityId entity)
{
    for (int shift = 24; shift >= 0; shift -= 8)
    {
        bytes.push_back(static_cast<std::uint8_t>(entity >> shift));
    }
}

// The high half comes first.
void AppendNumber(std::vector<std::uint8_t> &bytes, std::int64_t number)
{
    Append(bytes, static_cast<std::uint64_t>(number) >> 32, 4);
    Append(bytes, static_cast<std::uint64_t>(number), 4);
}

// Wraps bytes for CheckDelivery, which does not write to them.
Submessage ToBeRead(std::span<const std::uint8_t> whole)
{
    return {.Kind = SubmessageKind{whole[0]},
            .Flags = whole[1],
            .LittleEndian = (whole[1] & LittleEndian) != 0,
            .Whole = {const_cast<std::uint8_t *>(whole.data()), whole.size()}};
}

// 9.4.5.4: from the first number up to the base, and those whose bits are set after it.
std::vector<std::int64_t> NumbersOfGap(const Submessage &gap, const Delivery &said)
{
    RtpsReader body(gap.Body(), gap.LittleEndian);
    body.Skip(8 + 8);  // entities, first number
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
    read.IsFinal = (submessage.Flags & Final) != 0;
    if (submessage.Kind == SubmessageKind::Gap)
    {
        read.Gone = NumbersOfGap(submessage, *delivery);
    }
    return true;
}

// The GUID in a parameter list that names the subject; empty if there is none.
std::span<const std::uint8_t> GuidIn(std::span<const std::uint8_t> payload)
{
    constexpr std::size_t encapsulation = 4;
    constexpr std::uint8_t littleEndianList = 3;
    if (payload.size() < encapsulation)
    {
        return {};
    }
    RtpsReader list(payload.subspan(encapsulation), payload[1] == littleEndianList);
    while (list.IsGood() && list.Left() > 0)
    {
        const std::uint16_t id = list.U16();
        const auto value = list.Bytes(list.U16());
        if (list.IsGood() && (id == EndpointGuid || id == KeyHashParameter) && value.size() == 16)
        {
            return value;
        }
        if (id == Sentinel)
        {
            break;
        }
    }
    return {};
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
                     [&](const RtpsSubmessage<const std::uint8_t> &part)
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
                             std::copy_n(submessage.Body().begin(), all ? to.size() : 0, to.begin());
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
    constexpr std::size_t from = SubmessageHeaderSize + NumberInData + NumberSize;
    return Fnv1a()
        .AddByte(announcement[1])
        .Add(announcement.subspan(std::min(from, announcement.size())))
        .Sum();
}

void AppendDestination(std::vector<std::uint8_t> &message, const GuidPrefix &to)
{
    AppendSubmessageHeader(message, SubmessageKind::InfoDestination, to.size());
    message.insert(message.end(), to.begin(), to.end());
}

void AppendAnnouncement(std::vector<std::uint8_t> &message, std::span<const std::uint8_t> announcement,
                        std::int64_t number)
{
    const std::size_t at = message.size();
    message.insert(message.end(), announcement.begin(), announcement.end());
    message.resize((message.size() + 3) / 4 * 4);
    const bool littleEndian = (announcement[1] & LittleEndian) != 0;
    const auto put = [&](std::size_t offset, std::uint64_t value, std::size_t size)
    {
        for (std::size_t i = 0; i < size; ++i)
        {
            const std::size_t shift = 8 * (littleEndian ? i : size - 1 - i);
            message[at + offset + i] = static_cast<std::uint8_t>(value >> shift);
        }
    };
    put(2, message.size() - at - SubmessageHeaderSize, 2);
    put(SubmessageHeaderSize + ReaderInData, 0, 4);
    put(SubmessageHeaderSize + NumberInData, static_cast<std::uint64_t>(number) >> 32, 4);
    put(SubmessageHeaderSize + NumberInData + 4, static_cast<std::uint64_t>(number), 4);
}

void AppendHeartbeat(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t last,
                     std::uint32_t count)
{
    AppendSubmessageHeader(message, SubmessageKind::Heartbeat, 28);
    AppendEntity(message, ReaderOf(writer));
    AppendEntity(message, writer);
    AppendNumber(message, 1);
    AppendNumber(message, last);
    Append(message, count, 4);
}

void AppendGap(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t first, std::int64_t end)
{
    AppendSubmessageHeader(message, SubmessageKind::Gap, 28);
    AppendEntity(message, ReaderOf(writer));
    AppendEntity(message, writer);
    AppendNumber(message, first);
    AppendNumber(message, end);
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
    AppendSubmessageHeader(message, SubmessageKind::AckNack, 24 + 4 * words, Final);
    AppendEntity(message, ReaderOf(writer));
    AppendEntity(message, writer);
    AppendNumber(message, base);
    Append(message, bits, 4);
    for (std::size_t i = 0; i < words; ++i)
    {
        Append(message, bitmap[i], 4);
    }
    Append(message, count, 4);
}

void AppendEndOfParticipant(std::vector<std::uint8_t> &message, const GuidPrefix &participant,
                            std::int64_t number)
{
    // Octets to the inline QoS, entities, number; key hash, status, end of the list; the key.
    constexpr std::uint8_t disposedAndUnregistered = 0x03;
    constexpr std::size_t guidSize = 16;
    constexpr std::size_t inlineSize = 4 + guidSize + 8 + 4;
    constexpr std::size_t keySize = 4 + 4 + guidSize + 4;
    AppendSubmessageHeader(message, SubmessageKind::Data, 20 + inlineSize + keySize, InlineQos | KeyPayload);
    Append(message, 0, 2);
    Append(message, 16, 2);
    AppendEntity(message, ReaderOf(ParticipantWriter));
    AppendEntity(message, ParticipantWriter);
    AppendNumber(message, number);
    const auto appendGuid = [&]
    {
        message.insert(message.end(), participant.begin(), participant.end());
        AppendEntity(message, ParticipantEntity);
    };
    Append(message, KeyHashParameter, 2);
    Append(message, guidSize, 2);
    appendGuid();
    Append(message, StatusInfo, 2);
    Append(message, 4, 2);
    message.insert(message.end(), {0, 0, 0, disposedAndUnregistered});
    Append(message, Sentinel, 2);
    Append(message, 0, 2);
    message.insert(message.end(), {0, 3, 0, 0});
    Append(message, ParticipantGuid, 2);
    Append(message, guidSize, 2);
    appendGuid();
    Append(message, Sentinel, 2);
    Append(message, 0, 2);
}

}  // namespace Rabit::Rtps
