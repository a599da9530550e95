#include "model/RosTypeHash.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/Sha256.h"

namespace RabitIdl
{
namespace
{

// Numbers of type_description_interfaces/msg/FieldType. An array or sequence of a type has a number that is
// so much higher.
constexpr unsigned Nested = 1;
constexpr unsigned String = 17;
constexpr unsigned BoundedString = 21;
constexpr unsigned ArrayOf = 48;
constexpr unsigned BoundedSequenceOf = 96;
constexpr unsigned SequenceOf = 144;

unsigned NumberOf(Primitive primitive)
{
    switch (primitive)
    {
        case Primitive::Int8:
            return 2;
        case Primitive::Uint8:
            return 3;
        case Primitive::Int16:
            return 4;
        case Primitive::Uint16:
            return 5;
        case Primitive::Int32:
            return 6;
        case Primitive::Uint32:
            return 7;
        case Primitive::Int64:
            return 8;
        case Primitive::Uint64:
            return 9;
        case Primitive::Float:
            return 10;
        case Primitive::Double:
            return 11;
        case Primitive::Char:
            return 13;
        case Primitive::Bool:
            return 15;
        case Primitive::Octet:
            return 16;
    }
    return 0;
}

// `std_msgs/msg/String`; empty if ROS 2 has no such names.
std::string NameOf(const Definition &definition)
{
    const auto &scope = definition.Scope;
    const bool isRos = scope.size() == 2 && (scope[1] == "msg" || scope[1] == "srv" || scope[1] == "action");
    return isRos ? scope[0] + "/" + scope[1] + "/" + definition.Name : "";
}

using Structs = std::vector<const StructDefinition *>;

struct FieldType
{
    unsigned Number = 0;
    std::uint32_t Capacity = 0;
    std::uint32_t StringCapacity = 0;
    std::string NestedName;
};

// Empty if ROS 2 has no such type. Structs that it uses are added to `used`.
std::optional<FieldType> FieldTypeOf(const Type &alias, Structs &used)
{
    const Type &type = Unalias(alias);
    switch (type.What)
    {
        case Type::Kind::Primitive:
            return FieldType{NumberOf(type.Scalar), 0, 0, ""};
        case Type::Kind::String:
            return FieldType{type.Bound == 0 ? String : BoundedString, 0, type.Bound, ""};
        case Type::Kind::Named:
            break;
        case Type::Kind::Sequence:
        case Type::Kind::Array:
        {
            const Type::Kind element = Unalias(*type.Element).What;
            const bool isFlat = element != Type::Kind::Sequence && element != Type::Kind::Array;
            std::optional<FieldType> field = isFlat ? FieldTypeOf(*type.Element, used) : std::nullopt;
            if (field)
            {
                const bool isArray = type.What == Type::Kind::Array;
                field->Number += isArray ? ArrayOf : type.Bound == 0 ? SequenceOf : BoundedSequenceOf;
                field->Capacity = isArray ? type.Length : type.Bound;
            }
            return field;
        }
    }
    const auto *structure = dynamic_cast<const StructDefinition *>(type.Named);
    if (structure == nullptr || NameOf(*structure).empty())
    {
        return std::nullopt;
    }
    used.push_back(structure);
    return FieldType{Nested, 0, 0, NameOf(*structure)};
}

// The description of one struct in JSON, as Python writes it; empty if ROS 2 has no such type.
std::optional<std::string> DescriptionOf(const StructDefinition &definition, Structs &used)
{
    const std::string name = NameOf(definition);
    if (name.empty() || definition.Base != nullptr)
    {
        return std::nullopt;
    }
    std::string fields;
    for (const Member &member : definition.Members)
    {
        const auto type = FieldTypeOf(member.Type, used);
        if (!type)
        {
            return std::nullopt;
        }
        fields += (fields.empty() ? "{\"name\": \"" : ", {\"name\": \"") + member.Name +
                  "\", \"type\": {\"type_id\": " + std::to_string(type->Number) +
                  ", \"capacity\": " + std::to_string(type->Capacity) +
                  ", \"string_capacity\": " + std::to_string(type->StringCapacity) +
                  ", \"nested_type_name\": \"" + type->NestedName + "\"}}";
    }
    return "{\"type_name\": \"" + name + "\", \"fields\": [" + fields + "]}";
}

}  // namespace

std::string RosTypeHash(const StructDefinition &definition)
{
    Structs used;
    const auto own = DescriptionOf(definition, used);
    if (!own)
    {
        return "";
    }
    std::map<std::string, std::string> others;  // by name, as they stand in the description
    for (std::size_t i = 0; i < used.size(); ++i)
    {
        const auto [place, isNew] = others.try_emplace(NameOf(*used[i]));
        const auto other = isNew ? DescriptionOf(*used[i], used) : std::optional(std::string());
        if (!other)
        {
            return "";
        }
        place->second = isNew ? *other : place->second;
    }
    std::string list;
    for (const auto &[name, text] : others)
    {
        list += (list.empty() ? "" : ", ") + text;
    }
    return "RIHS01_" + Sha256Hex("{\"type_description\": " + *own + ", \"referenced_type_descriptions\": [" +
                                 list + "]}");
}

}  // namespace RabitIdl
