#include "guard/DiscoveryCheck.h"

#include <rabit/base/Fnv1a.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/ParticipantIdentity.h"
#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"
#include "guard/DeliveryCheck.h"

namespace Rabit::Rtps
{

namespace
{

using namespace Parameters;

constexpr int MostParameters = 128;
constexpr int MostLocators = 64;
constexpr std::uint32_t MostPartitions = 1024;

// The parameters of one sample found so far.
struct Found
{
    EntityId Subject = 0;
    bool Lease = false;
    bool Topic = false;
    bool Type = false;
    int Names = 0;
    std::optional<std::string> Name;
    int Locators = 0;
    Fnv1a Digest;
    Fnv1a DigestWithoutLease;
    std::vector<HostAddress> Hosts;
    std::vector<Place> Places;
    bool ListensToGroup = false;
    bool BestEffort = false;
    bool HasCard = false;

    void AddHost(const HostAddress &host)
    {
        if (std::find(Hosts.begin(), Hosts.end(), host) == Hosts.end())
        {
            Hosts.push_back(host);
        }
    }
    // The name of the subject; may be unsound.
    void Named(RtpsReader value)
    {
        const std::uint32_t size = value.U32();
        const auto text = value.Bytes(size);
        const auto end = std::find(text.begin(), text.end(), std::uint8_t{0});
        const bool isOne = Names++ == 0 && end != text.end() && std::next(end) == text.end();
        Name = isOne ? std::optional(std::string(text.begin(), end)) : std::nullopt;
    }
    void Digested(std::uint16_t id, std::span<const std::uint8_t> value)
    {
        Digest.AddByte(static_cast<std::uint8_t>(id));
        Digest.Add(value);
        if (id != LeaseDuration)
        {
            DigestWithoutLease.AddByte(static_cast<std::uint8_t>(id));
            DigestWithoutLease.Add(value);
        }
    }
};

// True for a terminated string within a limit that the vendor has but does not check.
bool IsString(RtpsReader &value)
{
    constexpr std::uint32_t Longest = 256;
    const std::uint32_t size = value.U32();
    if (size == 0 || size > Longest)
    {
        return false;
    }
    const auto text = value.Bytes(size);
    value.Skip(std::min<std::size_t>((4 - size % 4) % 4, value.Left()));
    return value.IsGood() && text.back() == 0;
}

bool IsOneString(RtpsReader value)
{
    return IsString(value) && value.Left() == 0;
}

bool IsListOfStrings(RtpsReader value)
{
    const std::uint32_t count = value.U32();
    bool good = count <= MostPartitions;
    for (std::uint32_t i = 0; good && i < count; ++i)
    {
        good = IsString(value);
    }
    return good && value.IsGood() && value.Left() == 0;
}

bool IsBytes(RtpsReader value)
{
    const std::uint32_t size = value.U32();
    value.Skip(size);
    return value.IsGood() && value.Left() == (4 - size % 4) % 4;
}

// The content of a sequence that passed IsBytes.
std::span<const std::uint8_t> ContentOf(RtpsReader value)
{
    const std::uint32_t size = value.U32();
    return value.Bytes(size);
}

bool IsRepresentations(RtpsReader value)
{
    const std::uint32_t count = value.U32();
    return value.IsGood() && count <= value.Left() / 2 && value.Left() - 2 * std::size_t{count} < 4;
}

bool IsGuidOf(const GuidPrefix &sender, std::span<const std::uint8_t> guid)
{
    const std::span<const std::uint8_t> prefix = guid.first(sender.size());
    return std::equal(sender.begin(), sender.end(), prefix.begin(), prefix.end());
}

// True if an announcement of this topic may be about `entity`.
bool IsSubjectOf(EntityId writer, EntityId entity)
{
    switch (writer)
    {
        case ParticipantWriter:
            return entity == ParticipantEntity;
        case PublicationsWriter:
            return IsWriter(entity) && !IsBuiltin(entity);
        case SubscriptionsWriter:
            return IsReader(entity) && !IsBuiltin(entity);
        default:
            return false;
    }
}

// A zero lease would make the vendor's timer run without a pause.
bool IsLease(RtpsReader value)
{
    const auto seconds = static_cast<std::int32_t>(value.U32());
    const std::uint32_t fraction = value.U32();
    constexpr std::uint32_t TenthOfASecond = 429496729;
    return value.IsGood() && value.Left() == 0 &&
           (seconds > 0 || (seconds == 0 && fraction >= TenthOfASecond));
}

// RTPS 2.3, 9.3.2: kinds of locators.
constexpr std::uint32_t UdpV4 = 1;
constexpr std::uint32_t UdpV6 = 2;

// The vendor ignores kinds that it does not support. Their ports may be any number: TCP has two in it.
bool IsLocator(RtpsReader value)
{
    constexpr std::uint32_t LargestPort = 65535;
    const std::uint32_t kind = value.U32();
    const std::uint32_t port = value.U32();
    const bool isPort = port >= 1 && port <= LargestPort;
    return value.IsGood() && value.Left() == 16 && (isPort || (kind != UdpV4 && kind != UdpV6));
}

// The IPv4 address and the port of a sound locator; empty for other kinds.
std::optional<Place> PlaceOf(RtpsReader locator)
{
    if (locator.U32() != UdpV4)
    {
        return std::nullopt;
    }
    Place place{.Host = {}, .Port = static_cast<std::uint16_t>(locator.U32())};
    const auto address = locator.Bytes(16);
    std::copy_n(address.end() - static_cast<std::ptrdiff_t>(place.Host.size()), place.Host.size(),
                place.Host.begin());
    return place;
}

// True for the addresses at which a participant itself can be reached.
bool IsUnicast(std::uint16_t id)
{
    return id == DefaultUnicastLocator || id == MetatrafficUnicastLocator;
}

// Size that the vendor expects, for participants and endpoints alike: it refuses another size or reads past
// the end.
std::size_t FixedSize(std::uint16_t id)
{
    switch (id)
    {
        case OwnershipStrength:
        case ProtocolVersion:
        case VendorId:
        case Durability:
        case Ownership:
        case DestinationOrder:
        case ExpectsInlineQos:
        case BuiltinEndpointSet:
        case DisablePositiveAcks:
            return 4;
        case TimeBasedFilter:
        case Presentation:
        case Deadline:
        case LatencyBudget:
        case Lifespan:
            return 8;
        case Reliability:
        case Liveliness:
            return 12;
        case DurabilityService:
            return 28;
        default:
            return 0;
    }
}

// Returns true if the parameter is sound; sets `wanted` to false if it is not used.
bool CheckParameter(EntityId writer, const GuidPrefix &sender, std::uint16_t id,
                    std::span<const std::uint8_t> bytes, bool littleEndian, Found &found, bool &wanted)
{
    const RtpsReader value(bytes, littleEndian);
    if (const std::size_t size = FixedSize(id))
    {
        if (id == BuiltinEndpointSet)
        {
            found.Digested(id, bytes);
        }
        if (id == Reliability)
        {
            constexpr std::uint32_t BestEffortKind = 1;  // 9.4.5.1 of RTPS 2.3
            found.BestEffort = RtpsReader(value).U32() == BestEffortKind;
        }
        return bytes.size() == size;
    }
    if (id == (writer == ParticipantWriter ? EntityName : TopicName))
    {
        found.Named(value);
    }
    switch (id)
    {
        case LeaseDuration:
            found.Lease = true;
            found.Digested(id, bytes);
            return IsLease(value);
        case TopicName:
            found.Topic = true;
            return IsOneString(value);
        case TypeName:
            found.Type = true;
            return IsOneString(value);
        case EntityName:
            return IsOneString(value);
        case Partition:
            return IsListOfStrings(value);
        case UserData:
            found.HasCard = IsBytes(value) && HasCard(ContentOf(value));
            return IsBytes(value);
        case GroupData:
        case TopicData:
            return IsBytes(value);
        case DataRepresentation:
            return IsRepresentations(value);
        case UnicastLocator:
        case MulticastLocator:
        case DefaultUnicastLocator:
        case DefaultMulticastLocator:
        case MetatrafficUnicastLocator:
        case MetatrafficMulticastLocator:
            found.Digested(id, bytes);
            if (!IsLocator(value) || ++found.Locators > MostLocators)
            {
                return false;
            }
            if (const auto place = PlaceOf(value); place && (IsUnicast(id) || id == UnicastLocator))
            {
                found.Places.push_back(*place);
                if (IsUnicast(id))
                {
                    found.AddHost(place->Host);
                }
            }
            found.ListensToGroup = found.ListensToGroup || id == DefaultMulticastLocator;
            return true;
        case ParticipantGuid:
            if (bytes.size() != 16 || !IsGuidOf(sender, bytes) || EntityOf(bytes) != ParticipantEntity)
            {
                return false;
            }
            if (writer == ParticipantWriter)
            {
                found.Subject = ParticipantEntity;
            }
            return true;
        case EndpointGuid:
            if (bytes.size() != 16 || !IsGuidOf(sender, bytes) || writer == ParticipantWriter ||
                !IsSubjectOf(writer, EntityOf(bytes)) ||
                (found.Subject != 0 && found.Subject != EntityOf(bytes)))
            {
                return false;
            }
            found.Subject = EntityOf(bytes);
            return true;
        case KeyHash:
            if (bytes.size() != 16 || !IsKeyOf(writer, sender, bytes) ||
                (found.Subject != 0 && found.Subject != EntityOf(bytes)))
            {
                return false;
            }
            found.Subject = EntityOf(bytes);
            return true;
        default:
            wanted = false;
            return true;
    }
}

// Cuts a sound lease to the longest one.
void BoundLease(std::span<std::uint8_t> value, bool littleEndian)
{
    RtpsReader lease(value, littleEndian);
    const auto seconds = static_cast<std::int32_t>(lease.U32());
    if (!IsLease(RtpsReader(value, littleEndian)) || seconds < LongestLease.count())
    {
        return;
    }
    constexpr auto longest = static_cast<std::uint32_t>(LongestLease.count());
    std::fill(value.begin(), value.end(), std::uint8_t{0});
    Write(value.first(4), longest, littleEndian);
}

// A list of parameters is an announcement, or the key of something that ended.
enum class Content
{
    Announcement,
    Key
};

bool IsComplete(EntityId writer, const Found &found, Content content)
{
    const bool isDescribed = writer == ParticipantWriter ? found.Lease : found.Topic && found.Type;
    return found.Subject != 0 && (content == Content::Key || isDescribed);
}

std::optional<Announcement> CheckParameters(EntityId writer, const GuidPrefix &sender,
                                            std::span<std::uint8_t> payload, Content content, Lease lease)
{
    constexpr std::uint8_t BigEndianList = 2;
    constexpr std::uint8_t LittleEndianList = 3;
    if (payload.size() < EncapsulationSize || payload[0] != 0 ||
        (payload[1] != BigEndianList && payload[1] != LittleEndianList))
    {
        return std::nullopt;
    }
    const bool littleEndian = payload[1] == LittleEndianList;
    const auto list = payload.subspan(EncapsulationSize);
    RtpsReader rest(list, littleEndian);
    Found found;
    for (int i = 0; i < MostParameters; ++i)
    {
        const auto parameter = TakeParameter(rest);
        if (!rest.IsGood())
        {
            return std::nullopt;
        }
        if (!parameter)
        {
            const bool hasCard = writer == ParticipantWriter && found.HasCard;
            return IsComplete(writer, found, content)
                       ? std::optional(
                             Announcement{.Subject = found.Subject,
                                          .Digest = (hasCard ? found.DigestWithoutLease : found.Digest).Sum(),
                                          .Name = std::move(found.Name),
                                          .IsBestEffort = found.BestEffort,
                                          .Hosts = std::move(found.Hosts),
                                          .Places = std::move(found.Places),
                                          .ListensToGroup = found.ListensToGroup,
                                          .HasCard = hasCard})
                       : std::nullopt;
        }
        const auto [id, value, at] = *parameter;
        if (id == LeaseDuration && lease == Lease::Bounded)
        {
            BoundLease(list.subspan(at + 4, value.size()), littleEndian);
        }
        bool wanted = true;
        if (value.size() % 4 != 0 || !CheckParameter(writer, sender, id, value, littleEndian, found, wanted))
        {
            return std::nullopt;
        }
        if (wanted && writer != ParticipantWriter)
        {
            found.Digested(id, value);
        }
        if (!wanted)
        {
            list[at] = list[at + 1] = Pad;
        }
    }
    return std::nullopt;
}

// True if the payload asserts the liveliness of `sender` (8.4.13.5), or is the key of such an assertion: the
// participant and the kind.
bool IsLivelinessOf(const GuidPrefix &sender, std::span<const std::uint8_t> payload, Content content)
{
    constexpr std::size_t KeySize = 4 + 12 + 4;
    const std::size_t smallestSize = content == Content::Key ? KeySize : KeySize + 4;
    return payload.size() >= smallestSize && payload[0] == 0 && payload[1] <= 1 &&
           IsGuidOf(sender, payload.subspan(4));
}

}  // namespace

std::optional<Announcement> CheckDiscovery(EntityId writer, const GuidPrefix &sender,
                                           std::span<std::uint8_t> payload, Lease lease)
{
    if (writer == LivelinessWriter)
    {
        return IsLivelinessOf(sender, payload, Content::Announcement) ? std::optional(Announcement{})
                                                                      : std::nullopt;
    }
    return CheckParameters(writer, sender, payload, Content::Announcement, lease);
}

bool CheckKey(EntityId writer, const GuidPrefix &sender, std::span<std::uint8_t> payload)
{
    return writer == LivelinessWriter
               ? IsLivelinessOf(sender, payload, Content::Key)
               : CheckParameters(writer, sender, payload, Content::Key, Lease::Bounded).has_value();
}

EntityId EntityOf(std::span<const std::uint8_t> guid)
{
    return RtpsReader(guid.subspan(sizeof(GuidPrefix)), false).Entity();
}

bool IsKeyOf(EntityId writer, const GuidPrefix &sender, std::span<const std::uint8_t> keyHash)
{
    return keyHash.size() == 16 && IsGuidOf(sender, keyHash) &&
           (writer == LivelinessWriter || IsSubjectOf(writer, EntityOf(keyHash)));
}

}  // namespace Rabit::Rtps
