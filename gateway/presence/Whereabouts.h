#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// Where a node runs, in words: `host uav1-pi, process 4711`. Two nodes of one name tell it while they hear
// each other, so that a person finds both.
namespace Whereabouts
{

// Bytes on the wire, padded with zeros, so that the size of a beat does not depend on the host's name.
inline constexpr std::size_t Size = 64;

std::string OfThisProcess();
// OfThisProcess(), as a beat carries it in place of a part of the announcement.
Gateway::AnnouncementPart Part();
// The whereabouts in the beat, printable and no longer than Size; `known` if there are none.
std::string In(const Gateway::Beat &beat, const std::string &known = "");
// True if the part carries whereabouts, and no part of an announcement.
inline bool IsIn(const Gateway::AnnouncementPart &part)
{
    return part.of == 0;
}

}  // namespace Whereabouts
}  // namespace Rabit
