#include "names/TypeDefinition.h"

#include <rabit/base/Fnv1a.h>

#include <cctype>
#include <charconv>
#include <cinttypes>
#include <cstddef>
#include <cstdio>
#include <map>
#include <string>

namespace Rabit
{
namespace
{

// The IDL with each run of white space and comments replaced by one blank.
std::string Normalized(const std::string &idl)
{
    std::string normalized;
    std::size_t at = 0;
    bool gap = false;
    while (at < idl.size())
    {
        if (idl.compare(at, 2, "//") == 0)
        {
            at = idl.find('\n', at);
            at = at == std::string::npos ? idl.size() : at;
            gap = true;
        }
        else if (idl.compare(at, 2, "/*") == 0)
        {
            const std::size_t end = idl.find("*/", at + 2);
            at = end == std::string::npos ? idl.size() : end + 2;
            gap = true;
        }
        else if (std::isspace(static_cast<unsigned char>(idl[at])) != 0)
        {
            ++at;
            gap = true;
        }
        else
        {
            if (gap && !normalized.empty())
            {
                normalized += ' ';
            }
            gap = false;
            normalized += idl[at++];
        }
    }
    return normalized;
}

struct KnownDefinition
{
    std::uint64_t Hash = 0;
    std::string LinkName;
};

KnownDefinition KnownDefinitionOf(const MessageType &type)
{
    const std::uint64_t hash = DefinitionHash(type.Name(), type.IdlText());
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016" PRIx64, hash);
    return {hash, type.Name() + "@" + digits};
}

// Cached, since it is needed for every message that is sent. Types live as long as the process, so no entry
// goes stale.
const KnownDefinition &FindDefinition(const MessageType &type)
{
    static thread_local std::map<const MessageType *, KnownDefinition> known;
    const auto found = known.find(&type);
    return found != known.end() ? found->second : known.emplace(&type, KnownDefinitionOf(type)).first->second;
}

}  // namespace

std::uint64_t DefinitionHash(const std::string &name, const std::string &idlText)
{
    return Fnv1a().Add(Normalized(name + "\n" + idlText)).Sum();
}

std::uint64_t DefinitionHash(const MessageType &type)
{
    return FindDefinition(type).Hash;
}

const std::string &LinkTypeName(const MessageType &type)
{
    return FindDefinition(type).LinkName;
}

LinkTypeParts SplitLinkTypeName(std::string_view name)
{
    const std::size_t at = name.rfind('@');
    LinkTypeParts parts{.Type = name.substr(0, at)};
    if (at != std::string_view::npos)
    {
        std::from_chars(name.data() + at + 1, name.data() + name.size(), parts.Definition, 16);
    }
    return parts;
}

}  // namespace Rabit
