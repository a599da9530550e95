#include "guard/TokenCheck.h"

#include <algorithm>
#include <optional>

namespace Rabit::Rtps
{

namespace
{

constexpr std::uint32_t MostTokens = 16;
constexpr std::uint32_t MostProperties = 64;

using Bytes = std::span<const std::uint8_t>;

// A string, or bytes, preceded by their number. The padding to a multiple of 4 may be missing at the end.
// Empty if bytes are missing.
std::optional<Bytes> TakeBytes(RtpsReader &from)
{
    const std::uint32_t size = from.U32();
    if (size > from.Left())
    {
        return std::nullopt;
    }
    const Bytes taken = from.Bytes(size);
    from.Skip(std::min<std::size_t>((4 - size % 4) % 4, from.Left()));
    return from.IsGood() ? std::optional(taken) : std::nullopt;
}

std::string_view TextOf(Bytes bytes)
{
    return {reinterpret_cast<const char *>(bytes.data()), bytes.size()};
}

// Cyclone DDS 0.10.2 skips the padding behind strings and bytes in the signed data without a check, and then
// reads behind its end (CVE-2024-10838). Data whose size is a multiple of 4 has all of the padding. A name
// has no zero but its last byte: the vendors would not agree on which property is meant.
bool IsBinaryProperty(Bytes name, Bytes value)
{
    const std::string_view text = TextOf(name);
    const std::size_t end = text.find('\0');
    return end != text.npos && end + 1 == text.size() &&
           (text.substr(0, end) != "c.pdata" || value.size() % 4 == 0);
}

// Each property consists of two of those: a name and a value. Calls visit(name, value) for each.
template <typename Visit>
bool TakeProperties(RtpsReader &from, const Visit &visit)
{
    const std::uint32_t count = from.U32();
    if (!from.IsGood() || count > MostProperties)
    {
        return false;
    }
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const auto name = TakeBytes(from);
        const auto value = name ? TakeBytes(from) : std::nullopt;
        if (!value)
        {
            return false;
        }
        visit(*name, *value);
    }
    return true;
}

// Takes a token; calls visit(name, value) for each of its binary properties.
template <typename Visit>
bool TakeToken(RtpsReader &from, const Visit &visit)
{
    return TakeBytes(from) && TakeProperties(from, [](Bytes, Bytes) {}) && TakeProperties(from, visit);
}

// Reads a generic message in the same way.
template <typename Visit>
bool ReadGenericMessage(Bytes payload, const Visit &visit)
{
    if (payload.size() < EncapsulationSize || payload[0] != 0 || payload[1] > 1)
    {
        return false;
    }
    RtpsReader body(payload.subspan(EncapsulationSize), payload[1] == 1);
    // Skips the message's identity, that of the related message, and the GUIDs of source and destination.
    constexpr std::size_t GuidSize = 16;
    body.Skip(2 * (GuidSize + SequenceSize) + 3 * GuidSize);
    if (!TakeBytes(body))
    {
        return false;
    }
    const std::uint32_t count = body.U32();
    bool good = body.IsGood() && count <= MostTokens;
    for (std::uint32_t i = 0; good && i < count; ++i)
    {
        good = TakeToken(body, visit);
    }
    return good && body.Left() < 4;
}

}  // namespace

bool IsToken(RtpsReader &from)
{
    return TakeToken(from, [](Bytes, Bytes) {});
}

bool IsGenericMessage(std::span<const std::uint8_t> payload)
{
    bool isSound = true;
    return ReadGenericMessage(payload, [&](Bytes name, Bytes value)
                              { isSound = isSound && IsBinaryProperty(name, value); }) &&
           isSound;
}

std::span<const std::uint8_t> BinaryPropertyOf(std::span<const std::uint8_t> payload, std::string_view name)
{
    Bytes found;
    const bool isSound =
        ReadGenericMessage(payload,
                           [&](Bytes of, Bytes value)
                           {
                               const std::string_view text = TextOf(of);
                               if (found.empty() && text.size() == name.size() + 1 && text.starts_with(name))
                               {
                                   found = value;
                               }
                           });
    return isSound ? found : Bytes();
}

}  // namespace Rabit::Rtps
