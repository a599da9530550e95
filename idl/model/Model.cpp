#include "model/Model.h"

#include <algorithm>

namespace RabitIdl
{

unsigned SizeOf(Primitive primitive)
{
    switch (primitive)
    {
        case Primitive::Bool:
        case Primitive::Char:
        case Primitive::Octet:
        case Primitive::Int8:
        case Primitive::Uint8:
            return 1;
        case Primitive::Int16:
        case Primitive::Uint16:
            return 2;
        case Primitive::Int32:
        case Primitive::Uint32:
        case Primitive::Float:
            return 4;
        case Primitive::Int64:
        case Primitive::Uint64:
        case Primitive::Double:
            return 8;
    }
    return 0;
}

const Type &Unalias(const Type &type)
{
    const Type *current = &type;
    while (current->What == Type::Kind::Named)
    {
        const auto *alias = dynamic_cast<const TypedefDefinition *>(current->Named);
        if (alias == nullptr)
        {
            break;
        }
        current = &alias->Type;
    }
    return *current;
}

std::vector<const Member *> AllMembers(const StructDefinition &definition)
{
    std::vector<const Member *> all;
    if (definition.Base != nullptr)
    {
        all = AllMembers(*definition.Base);
    }
    for (const Member &member : definition.Members)
    {
        all.push_back(&member);
    }
    return all;
}

bool HasKey(const StructDefinition &definition)
{
    const auto members = AllMembers(definition);
    return std::any_of(members.begin(), members.end(), [](const Member *member) { return member->Key; });
}

std::vector<const Member *> KeyMembers(const StructDefinition &definition)
{
    std::vector<const Member *> members = AllMembers(definition);
    if (HasKey(definition))
    {
        members.erase(
            std::remove_if(members.begin(), members.end(), [](const Member *member) { return !member->Key; }),
            members.end());
    }
    return members;
}

bool IsMessage(const StructDefinition &definition)
{
    return !definition.Nested;
}

}  // namespace RabitIdl
