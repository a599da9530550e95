#include "guard/TokenCheck.h"

#include <algorithm>

namespace Rabit::Rtps
{

namespace
{

constexpr std::uint32_t MostTokens = 16;
constexpr std::uint32_t MostProperties = 64;

// A string, or bytes, preceded by their number. The padding to a multiple of 4 may be missing at the end.
bool TakeBytes(RtpsReader &from)
{
    const std::uint32_t size = from.U32();
    if (size > from.Left())
    {
        return false;
    }
    from.Skip(size);
    from.Skip(std::min<std::size_t>((4 - size % 4) % 4, from.Left()));
    return from.IsGood();
}

// Each property consists of two of those: a name and a value.
bool TakeProperties(RtpsReader &from)
{
    const std::uint32_t count = from.U32();
    bool good = from.IsGood() && count <= MostProperties;
    for (std::uint32_t i = 0; good && i < count; ++i)
    {
        good = TakeBytes(from) && TakeBytes(from);
    }
    return good;
}

}  // namespace

bool IsToken(RtpsReader &from)
{
    return TakeBytes(from) && TakeProperties(from) && TakeProperties(from);
}

bool IsGenericMessage(std::span<const std::uint8_t> payload)
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
        good = IsToken(body);
    }
    return good && body.Left() < 4;
}

}  // namespace Rabit::Rtps
