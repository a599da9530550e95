#pragma once

#include <rabit/idl/MessageType.h>

#include <cstdint>
#include <string>

namespace Rabit
{

// Returns a hash (FNV-1a, 64 bits) of a type's name and IDL. Each run of comments and white space counts as
// one blank. Two nodes that were built from different versions of one IDL file have different hashes for
// one type name.
std::uint64_t DefinitionHash(const MessageType &type);
// The same hash, of a type with that IDL name and text.
std::uint64_t DefinitionHash(const std::string &name, const std::string &idlText);

}  // namespace Rabit
