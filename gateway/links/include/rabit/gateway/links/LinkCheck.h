#pragma once

#include <rabit/base/Fnv1a.h>

#include <cstdint>
#include <string_view>

namespace Rabit
{

// LinkFrame::Check: a 64-bit FNV-1a hash whose halves are folded into 32 bits.
namespace LinkCheck
{

// The check of a long frame.
inline std::uint32_t OfName(std::string_view destination)
{
    return Fnv1a().Add(destination).Folded();
}

// The check of a short frame, over all that it leaves out.
inline std::uint32_t OfShort(std::string_view destination, std::uint64_t senderLife,
                             std::uint64_t receiverLife, std::uint32_t clock, std::uint32_t echoClock)
{
    return Fnv1a()
        .Add(destination)
        .AddNumber(senderLife)
        .AddNumber(receiverLife)
        .AddNumber(clock)
        .AddNumber(echoClock)
        .Folded();
}

}  // namespace LinkCheck

}  // namespace Rabit
