#include "names/TypeDefinition.h"

#include <rabit/base/Fnv1a.h>

#include <cctype>
#include <cstddef>
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

}  // namespace

std::uint64_t DefinitionHash(const std::string &name, const std::string &idlText)
{
    return Fnv1a().Add(Normalized(name + "\n" + idlText)).Sum();
}

std::uint64_t DefinitionHash(const MessageType &type)
{
    // Cached, since it is called for every message that is sent. Types live as long as the process, so no
    // entry goes stale.
    static thread_local std::map<const MessageType *, std::uint64_t> hashes;
    const auto found = hashes.find(&type);
    return found != hashes.end()
               ? found->second
               : hashes.emplace(&type, DefinitionHash(type.Name(), type.IdlText())).first->second;
}

}  // namespace Rabit
