#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// Where a node runs, in words: `host uav1-pi, process 4711`. Nodes say it of themselves while they hear
// another one of their name, so that a person finds both.
namespace Whereabouts
{

// As they are on the wire, filled up with zeros: what a beat takes depends on no host's name.
inline constexpr std::size_t Size = 64;

std::string OfThisProcess();
// That, as a beat carries it instead of a part of the announcement.
Gateway::AnnouncementPart Part();
// What the beat says of it: printable, and no longer than Size; empty if it says nothing.
std::string In(const Gateway::Beat &beat);
// Whether it is this, and no part of an announcement.
inline bool IsIn(const Gateway::AnnouncementPart &part)
{
    return part.of == 0;
}

}  // namespace Whereabouts
}  // namespace Rabit
