#pragma once

#include <rabit/idl/MessageType.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace Rabit
{

// Returns a hash (FNV-1a, 64 bits) of a type's name and IDL. Each run of comments and white space counts as
// one blank. Two nodes that were built from different versions of one IDL file have different hashes for
// one type name.
std::uint64_t DefinitionHash(const MessageType &type);
// The same hash, of a type with that IDL name and text.
std::uint64_t DefinitionHash(const std::string &name, const std::string &idlText);

// How the queue links name a type: by its IDL name and its definition, as `Uav::Goto@0123456789abcdef`. So a
// receiver that was built with another definition of the type does not accept its messages. Valid as long as
// the calling thread.
const std::string &LinkTypeName(const MessageType &type);

// The parts of such a name. Without `@` all of it is the type's name, and the hash is 0.
struct LinkTypeParts
{
    std::string_view Type;
    std::uint64_t Definition = 0;
};
LinkTypeParts SplitLinkTypeName(std::string_view name);

}  // namespace Rabit
