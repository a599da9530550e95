#include "types/KnownTexts.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <vector>

#include "names/TypeDefinition.h"

namespace Rabit
{

const std::string *KnownTexts::Find(std::uint64_t definition)
{
    // Types are added, and never taken away.
    if (const std::vector<std::string> names = MessageTypeRegistry::Names(); names.size() != _types)
    {
        _types = names.size();
        for (const std::string &name : names)
        {
            const MessageType *type = MessageTypeRegistry::Find(name);
            _texts[DefinitionHash(*type)] = &type->IdlText();
        }
    }
    const auto found = _texts.find(definition);
    return found == _texts.end() ? nullptr : found->second;
}

}  // namespace Rabit
