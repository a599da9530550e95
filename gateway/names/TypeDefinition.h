#pragma once

#include <rabit/idl/MessageType.h>

#include <cstdint>
#include <string>

namespace Rabit
{

// A hash (FNV-1a, 64 bit) of a type's IDL without comments and white space. Two nodes that were built from
// different versions of one IDL file see different hashes under the same type name.
std::uint64_t DefinitionHash(const MessageType &type);
// The same, of a type of that IDL name and text.
std::uint64_t DefinitionHash(const std::string &name, const std::string &idlText);

}  // namespace Rabit
