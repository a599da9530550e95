// How many bytes values take on the wire, as plain XCDR1 (OMG DDS-XTypes 1.3, 7.4.1).
#pragma once

#include "model/Model.h"

#include <optional>

namespace RabitIdl
{

// Fewest bytes that any value of the type takes, alignment not counted.
std::uint64_t MinSize(const Type &type);
std::uint64_t MinSize(const Definition &definition);
// Bytes that a new value allocates at most: texts of @default, with their terminating zero.
std::uint64_t FreshSize(const Type &type);
std::uint64_t FreshSize(const Definition &definition);
// Bytes of every value of the struct that starts a sample; nothing if they differ.
std::optional<std::uint64_t> FixedSize(const StructDefinition &definition);
// Most bytes that the key of a struct takes; nothing if there is no limit. 0 without keys.
std::optional<std::uint64_t> MaxKeySize(const StructDefinition &definition);

}  // namespace RabitIdl
