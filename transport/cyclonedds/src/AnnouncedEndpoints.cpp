#include "AnnouncedEndpoints.h"

#include <algorithm>
#include <cstddef>

#include "common/ParticipantIdentity.h"
#include "common/RtpsSubmessages.h"

namespace Rabit::Cyclone
{

namespace
{

// OMG DDSI-RTPS 2.3, 9.4
constexpr std::uint8_t Data = 0x15;
constexpr std::uint8_t LittleEndian = 0x01;
constexpr std::uint8_t InlineQos = 0x02;
constexpr std::uint8_t HasData = 0x04;
constexpr std::size_t WriterAt = 8;
constexpr std::size_t PayloadAt = 20;
constexpr std::size_t EncapsulationSize = 4;
constexpr std::uint8_t ParametersLittleEndian = 0x03;  // PL_CDR_LE
// 9.6.2.2.2
constexpr std::uint16_t UserData = 0x002c;
constexpr std::uint16_t EndpointSet = 0x0058;
constexpr std::uint16_t End = 0x0001;
// 9.6.2.2.1 and OMG DDS-XTypes 1.3, 7.6.3.3.5: bits of the set.
constexpr std::uint32_t Liveliness = 1u << 10 | 1u << 11;
constexpr std::uint32_t TypeLookup = 1u << 12 | 1u << 13 | 1u << 14 | 1u << 15;
// OMG DDS Security 1.1, 7.3.7.1
constexpr std::uint32_t Secure = 0x0fff0000;

std::uint32_t Number(std::span<const std::uint8_t> bytes, std::size_t size)
{
    std::uint32_t number = 0;
    for (std::size_t i = size; i-- > 0;)
    {
        number = number << 8 | bytes[i];
    }
    return number;
}

std::uint16_t Short(std::span<const std::uint8_t> bytes)
{
    return static_cast<std::uint16_t>(Number(bytes, 2));
}

// The value of a parameter in a little-endian list; empty if the list has none.
std::span<std::uint8_t> Find(std::span<std::uint8_t> list, std::uint16_t wanted)
{
    while (list.size() >= 4)
    {
        const std::uint16_t id = Short(list);
        const std::size_t size = Short(list.subspan(2));
        if (id == End || size > list.size() - 4)
        {
            return {};
        }
        if (id == wanted)
        {
            return list.subspan(4, size);
        }
        list = list.subspan(4 + size);
    }
    return {};
}

// The bytes behind a list of parameters.
std::span<std::uint8_t> After(std::span<std::uint8_t> list)
{
    while (list.size() >= 4)
    {
        const std::size_t size = Short(list.subspan(2));
        if (Short(list) == End)
        {
            return list.subspan(4);
        }
        list = list.subspan(std::min(4 + size, list.size()));
    }
    return {};
}

// The parameter list in the announcement of a participant. Empty for other submessages, and for a goodbye,
// which has a key alone. This vendor announces in little-endian.
std::span<std::uint8_t> ParametersOf(std::span<std::uint8_t> body, std::uint8_t kind, std::uint8_t flags)
{
    if (kind != Data || (flags & (LittleEndian | HasData)) != (LittleEndian | HasData) ||
        body.size() < PayloadAt ||
        !std::equal(ParticipantWriterId.begin(), ParticipantWriterId.end(), body.begin() + WriterAt))
    {
        return {};
    }
    const auto rest = body.subspan(PayloadAt);
    const auto payload = (flags & InlineQos) != 0 ? After(rest) : rest;
    if (payload.size() < EncapsulationSize || payload[1] != ParametersLittleEndian)
    {
        return {};
    }
    return payload.subspan(EncapsulationSize);
}

bool IsOfRabitNode(std::span<std::uint8_t> parameters)
{
    const auto value = Find(parameters, UserData);
    if (value.size() < 4)
    {
        return false;
    }
    const std::size_t size = std::min<std::size_t>(Number(value, 4), value.size() - 4);
    return ParseUserData(value.subspan(4, size)).has_value();
}

bool LeaveOut(std::span<std::uint8_t> parameters)
{
    const auto set = Find(parameters, EndpointSet);
    if (set.size() < 4 || (Number(set, 4) & Secure) != 0 || !IsOfRabitNode(parameters))
    {
        return false;
    }
    std::uint32_t left = Number(set, 4) & ~(Liveliness | TypeLookup);
    const bool changed = left != Number(set, 4);
    for (std::size_t i = 0; i < 4; ++i, left >>= 8)
    {
        set[i] = static_cast<std::uint8_t>(left & 0xff);
    }
    return changed;
}

}  // namespace

bool LeaveOutIdleEndpoints(std::span<std::uint8_t> datagram)
{
    bool changed = false;
    VisitSubmessages(datagram,
                     [&changed](const RtpsSubmessage<std::uint8_t> &submessage)
                     {
                         const auto parameters =
                             ParametersOf(submessage.Body(), submessage.Kind, submessage.Flags);
                         changed = LeaveOut(parameters) || changed;
                     });
    return changed;
}

}  // namespace Rabit::Cyclone
