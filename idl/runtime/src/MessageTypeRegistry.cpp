#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/idl/SelfDescribing.h>

#include <map>
#include <mutex>
#include <shared_mutex>
#include <stdexcept>
#include <typeindex>
#include <unordered_map>

namespace Rabit
{
namespace
{

struct Types
{
    std::shared_mutex Mutex;
    std::map<std::string, const MessageType *> ByName;
    std::unordered_map<std::type_index, const MessageType *> ByClass;
};

// Made on first use: types are added while static objects are initialised. Never destroyed: threads may
// still use it when static objects are destroyed.
Types &All()
{
    static Types &types = *new Types;
    return types;
}

}  // namespace

void MessageTypeRegistry::Add(const MessageType &type)
{
    Types &types = All();
    const std::unique_lock lock(types.Mutex);
    const auto [entry, isNew] = types.ByName.emplace(type.Name(), &type);
    if (!isNew && entry->second->IdlText() != type.IdlText())
    {
        throw std::logic_error("MessageTypeRegistry: two different definitions of the IDL type " +
                               type.Name());
    }
    types.ByClass.emplace(type.CppType(), entry->second);
}

const MessageType *MessageTypeRegistry::Find(const std::string &name)
{
    Types &types = All();
    const std::shared_lock lock(types.Mutex);
    const auto entry = types.ByName.find(name);
    return entry == types.ByName.end() ? nullptr : entry->second;
}

const MessageType *MessageTypeRegistry::Of(const RabitMessage &message)
{
    Types &types = All();
    {
        const std::shared_lock lock(types.Mutex);
        const auto entry = types.ByClass.find(typeid(message));
        if (entry != types.ByClass.end() && entry->second->IsTypeOf(message))
        {
            return entry->second;
        }
    }
    const auto *described = dynamic_cast<const Idl::SelfDescribing *>(&message);
    return described == nullptr ? nullptr : &described->IdlType();
}

std::vector<std::string> MessageTypeRegistry::Names()
{
    Types &types = All();
    const std::shared_lock lock(types.Mutex);
    std::vector<std::string> names;
    names.reserve(types.ByName.size());
    for (const auto &[name, type] : types.ByName)
    {
        names.push_back(name);
    }
    return names;
}

}  // namespace Rabit
