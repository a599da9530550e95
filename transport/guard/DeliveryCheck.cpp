#include "guard/DeliveryCheck.h"

#include <rabit/transport/Transport.h>

#include "common/RtpsReader.h"

namespace Rabit::Rtps
{

namespace
{

// Smaller fragments have no use, and the vendor writes a mark for each into the sample's buffer.
constexpr std::uint16_t SmallestFragment = 64;
constexpr int MostInlineParameters = 64;

bool IsSequence(std::int64_t number)
{
    return number >= 1 && number < LargestSequence;
}

void ReadEntities(RtpsReader &body, Delivery &delivery)
{
    delivery.Reader = body.Entity();
    delivery.Writer = body.Entity();
}

// For a sample, heartbeat or gap: the reader may be unspecified.
bool AreFromWriter(const Delivery &delivery)
{
    if (!IsWriter(delivery.Writer))
    {
        return false;
    }
    // Builtin readers hear only the builtin writer of the same topic, and other readers none of them.
    return delivery.Reader == 0 ||
           (IsReader(delivery.Reader) && IsBuiltin(delivery.Reader) == IsBuiltin(delivery.Writer) &&
            (!IsBuiltin(delivery.Reader) || delivery.Reader >> 8 == delivery.Writer >> 8));
}

bool AreFromReader(const Delivery &delivery)
{
    return delivery.Reader != 0 && AreFromWriter(delivery);
}

// The parameters in front of a sample (8.7), up to the sentinel.
bool ReadInlineQos(RtpsReader &body, Delivery &delivery)
{
    using namespace Parameters;
    for (int i = 0; i < MostInlineParameters; ++i)
    {
        const auto parameter = TakeParameter(body);
        if (!parameter)
        {
            return body.IsGood();
        }
        const auto [id, value, at] = *parameter;
        if (value.size() % 4 != 0 || (id == KeyHash && value.size() != 16) ||
            (id == StatusInfo && value.size() != 4) || (id == RelatedSample && value.size() != 24))
        {
            return false;
        }
        if (id == KeyHash)
        {
            delivery.KeyHash = value;
        }
        if (id == StatusInfo && (value[3] & 3) != 0)
        {
            delivery.Alive = false;
        }
    }
    return false;
}

// Reads the fragment numbers; returns false if the payload has not the size that they imply.
bool ReadFragments(RtpsReader &body, Delivery &delivery)
{
    delivery.FirstFragment = body.U32();
    const std::uint16_t count = body.U16();
    delivery.FragmentSize = body.U16();
    delivery.SampleSize = body.U32();
    if (!body.IsGood() || delivery.FirstFragment == 0 || count == 0 ||
        delivery.FragmentSize < SmallestFragment || delivery.SampleSize == 0 ||
        delivery.SampleSize > LargestSample)
    {
        return false;
    }
    const std::uint64_t last = std::uint64_t{delivery.FirstFragment} + count - 1;
    const std::uint64_t all =
        (std::uint64_t{delivery.SampleSize} + delivery.FragmentSize - 1) / delivery.FragmentSize;
    delivery.LastFragment = static_cast<std::uint32_t>(last);
    return last <= all;
}

bool HasItsFragments(const Delivery &delivery)
{
    const std::uint64_t begin = std::uint64_t{delivery.FirstFragment - 1} * delivery.FragmentSize;
    const std::uint64_t end = std::uint64_t{delivery.LastFragment} * delivery.FragmentSize;
    const std::uint64_t size = (end < delivery.SampleSize ? end : delivery.SampleSize) - begin;
    return delivery.Payload.size() >= size;
}

std::optional<Delivery> CheckSample(const Submessage &submessage, RtpsReader body)
{
    const bool fragmented = submessage.Kind == SubmessageKind::DataFrag;
    const std::uint8_t dataFlag = fragmented ? std::uint8_t{0} : DataFlag;
    const std::uint8_t keyFlag = fragmented ? std::uint8_t{0x04} : KeyFlag;
    // octetsToInlineQos, counted from behind itself: extends over the entities, the number and the fragments.
    // No version of the protocol has had anything else there.
    const std::uint16_t toInlineQos = fragmented ? 28 : 16;
    Delivery delivery;
    delivery.Alive = true;
    body.Skip(2);  // extra flags
    const bool sound = body.U16() == toInlineQos;
    ReadEntities(body, delivery);
    delivery.First = delivery.Last = body.Sequence();
    if (!sound || !IsSequence(delivery.First) || !AreFromWriter(delivery) ||
        (fragmented && !ReadFragments(body, delivery)) ||
        ((submessage.Flags & InlineQosFlag) != 0 && !ReadInlineQos(body, delivery)) || !body.IsGood())
    {
        return std::nullopt;
    }
    delivery.Payload = submessage.Body().subspan(body.Position());
    delivery.HasKeyPayload = (submessage.Flags & keyFlag) != 0;
    const bool hasData = fragmented || (submessage.Flags & dataFlag) != 0;
    if (fragmented)
    {
        return !delivery.HasKeyPayload && HasItsFragments(delivery) ? std::optional(delivery) : std::nullopt;
    }
    if (hasData && delivery.HasKeyPayload)
    {
        return std::nullopt;
    }
    if ((hasData || delivery.HasKeyPayload) && delivery.Payload.size() < EncapsulationSize)
    {
        return std::nullopt;
    }
    // An alive sample has a value; the vendor would deliver a sample without bytes.
    if (delivery.Alive && !hasData)
    {
        return std::nullopt;
    }
    return delivery;
}

std::optional<Delivery> CheckHeartbeat(RtpsReader body)
{
    Delivery delivery;
    ReadEntities(body, delivery);
    delivery.First = body.Sequence();
    delivery.Last = body.Sequence();
    delivery.CountAt = body.Position();
    body.U32();
    const bool sound = body.IsGood() && AreFromWriter(delivery) && IsSequence(delivery.First) &&
                       delivery.Last >= delivery.First - 1 && delivery.Last < LargestSequence;
    return sound ? std::optional(delivery) : std::nullopt;
}

std::optional<Delivery> CheckHeartbeatFrag(RtpsReader body)
{
    Delivery delivery;
    ReadEntities(body, delivery);
    delivery.First = delivery.Last = body.Sequence();
    delivery.FirstFragment = delivery.LastFragment = body.U32();
    delivery.CountAt = body.Position();
    body.U32();
    const bool sound = body.IsGood() && AreFromWriter(delivery) && IsSequence(delivery.First);
    return sound ? std::optional(delivery) : std::nullopt;
}

std::optional<Delivery> CheckGap(RtpsReader body)
{
    Delivery delivery;
    ReadEntities(body, delivery);
    delivery.First = body.Sequence();
    const std::int64_t base = body.Sequence();
    delivery.Last = base - 1 + body.Bits();
    const bool sound = body.IsGood() && AreFromWriter(delivery) && IsSequence(delivery.First) &&
                       base >= delivery.First && delivery.Last < LargestSequence;
    return sound ? std::optional(delivery) : std::nullopt;
}

std::optional<Delivery> CheckAckNack(RtpsReader body)
{
    Delivery delivery;
    ReadEntities(body, delivery);
    delivery.First = body.Sequence();
    delivery.Last = delivery.First - 1 + body.Bits();
    delivery.CountAt = body.Position();
    body.U32();
    const bool sound =
        body.IsGood() && AreFromReader(delivery) && delivery.First >= 0 && delivery.Last < LargestSequence;
    return sound ? std::optional(delivery) : std::nullopt;
}

std::optional<Delivery> CheckNackFrag(RtpsReader body)
{
    Delivery delivery;
    ReadEntities(body, delivery);
    delivery.First = delivery.Last = body.Sequence();
    delivery.FirstFragment = body.U32();
    const std::uint32_t bits = body.Bits();
    delivery.LastFragment = delivery.FirstFragment + (bits > 0 ? bits - 1 : 0);
    delivery.CountAt = body.Position();
    body.U32();
    const bool sound = body.IsGood() && AreFromReader(delivery) && IsSequence(delivery.First) &&
                       delivery.FirstFragment >= 1 && delivery.FirstFragment <= LargestSample;
    return sound ? std::optional(delivery) : std::nullopt;
}

}  // namespace

bool IsKnownBuiltin(EntityId writer)
{
    return writer == ParticipantWriter || writer == PublicationsWriter || writer == SubscriptionsWriter ||
           writer == LivelinessWriter;
}

bool IsWriter(EntityId entity)
{
    const EntityId kind = entity & 0x3f;
    return kind == 0x02 || kind == 0x03;
}

bool IsReader(EntityId entity)
{
    const EntityId kind = entity & 0x3f;
    return kind == 0x04 || kind == 0x07;
}

std::optional<Delivery> CheckDelivery(const Submessage &submessage)
{
    const RtpsReader body = submessage.Reader();
    switch (submessage.Kind)
    {
        case SubmessageKind::Data:
        case SubmessageKind::DataFrag:
            return CheckSample(submessage, body);
        case SubmessageKind::Heartbeat:
            return CheckHeartbeat(body);
        case SubmessageKind::HeartbeatFrag:
            return CheckHeartbeatFrag(body);
        case SubmessageKind::Gap:
            return CheckGap(body);
        case SubmessageKind::AckNack:
            return CheckAckNack(body);
        case SubmessageKind::NackFrag:
            return CheckNackFrag(body);
        default:
            return std::nullopt;
    }
}

}  // namespace Rabit::Rtps
