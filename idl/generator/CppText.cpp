#include "CppText.h"

#include "model/LiteralText.h"
#include "model/Names.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace RabitIdl
{
namespace
{

std::string IntegerText(Primitive primitive, std::int64_t value)
{
    switch (primitive)
    {
        case Primitive::Int64:
            // The most negative value has no literal of its own.
            return value == std::numeric_limits<std::int64_t>::min() ? "(-9223372036854775807LL - 1)"
                                                                     : std::to_string(value) + "LL";
        case Primitive::Uint64:
            return std::to_string(static_cast<std::uint64_t>(value)) + "ULL";
        case Primitive::Uint32:
            return std::to_string(static_cast<std::uint32_t>(value)) + "U";
        case Primitive::Int32:
            return value == std::numeric_limits<std::int32_t>::min() ? "(-2147483647 - 1)"
                                                                     : std::to_string(value);
        case Primitive::Bool:
            return value != 0 ? "true" : "false";
        case Primitive::Char:
            return "static_cast<char>(" + std::to_string(value) + ")";
        case Primitive::Float:
        case Primitive::Double:
            return std::to_string(value) + ".0";
        default:
            return std::to_string(value);
    }
}

std::string FloatText(Primitive primitive, double value)
{
    const std::string type = CppPrimitive(primitive);
    if (std::isnan(value))
    {
        return "::std::numeric_limits<" + type + ">::quiet_NaN()";
    }
    if (std::isinf(value))
    {
        return (value < 0 ? "-" : "") + ("::std::numeric_limits<" + type + ">::infinity()");
    }
    return Number(value) + (primitive == Primitive::Float ? "F" : "");
}

}  // namespace

std::string CppPrimitive(Primitive primitive)
{
    switch (primitive)
    {
        case Primitive::Bool:
            return "bool";
        case Primitive::Char:
            return "char";
        case Primitive::Octet:
        case Primitive::Uint8:
            return "::std::uint8_t";
        case Primitive::Int8:
            return "::std::int8_t";
        case Primitive::Int16:
            return "::std::int16_t";
        case Primitive::Uint16:
            return "::std::uint16_t";
        case Primitive::Int32:
            return "::std::int32_t";
        case Primitive::Uint32:
            return "::std::uint32_t";
        case Primitive::Int64:
            return "::std::int64_t";
        case Primitive::Uint64:
            return "::std::uint64_t";
        case Primitive::Float:
            return "float";
        case Primitive::Double:
            return "double";
    }
    return "";
}

std::string CppType(const Type &type)
{
    switch (type.What)
    {
        case Type::Kind::Primitive:
            return CppPrimitive(type.Scalar);
        case Type::Kind::String:
            return "::std::string";
        case Type::Kind::Sequence:
        {
            const std::string maker = MakerOf(*type.Element);
            return "::std::vector<" + CppType(*type.Element) +
                   (maker.empty() ? ">" : ", ::Rabit::Idl::FreshAllocator<" + maker + ">>");
        }
        case Type::Kind::Array:
            return "::std::array<" + CppType(*type.Element) + ", " + std::to_string(type.Length) + ">";
        case Type::Kind::Named:
        {
            const auto *alias = dynamic_cast<const TypedefDefinition *>(type.Named);
            return alias != nullptr && alias->InIdlOnly ? CppType(alias->Type)
                                                        : CppScopedName(type.Named->Scope, type.Named->Name);
        }
    }
    return "";
}

std::string MakerOf(const Type &alias)
{
    const Type &type = Unalias(alias);
    if (type.What == Type::Kind::Array)
    {
        const std::string element = MakerOf(*type.Element);
        return element.empty()
                   ? ""
                   : "::Rabit::Idl::FreshArray<" + element + ", " + std::to_string(type.Length) + ">";
    }
    const auto *definition =
        type.What == Type::Kind::Named ? dynamic_cast<const EnumDefinition *>(type.Named) : nullptr;
    if (definition == nullptr || definition->Enumerators[definition->Default].Value == 0)
    {
        return "";
    }
    const std::string name = CppScopedName(definition->Scope, definition->Name);
    return "::Rabit::Idl::FreshEnum<" + name + ", " + name +
           "::" + definition->Enumerators[definition->Default].Name + ">";
}

std::string CodecOf(const Type &alias)
{
    const Type &type = Unalias(alias);
    const std::string prefix = "::Rabit::Idl::";
    switch (type.What)
    {
        case Type::Kind::Primitive:
            return type.Scalar == Primitive::Bool ? prefix + "Boolean"
                                                  : prefix + "Scalar<" + CppPrimitive(type.Scalar) + ">";
        case Type::Kind::String:
            return prefix + "Text<" + std::to_string(type.Bound) + ">";
        case Type::Kind::Sequence:
            return prefix + "List<" + CodecOf(*type.Element) + ", " + std::to_string(type.Bound) +
                   (MakerOf(*type.Element).empty() ? ">" : ", " + CppType(type) + ">");
        case Type::Kind::Array:
            return prefix + "Fixed<" + CodecOf(*type.Element) + ", " + std::to_string(type.Length) + ">";
        case Type::Kind::Named:
            return prefix + "Codec<" + CppScopedName(type.Named->Scope, type.Named->Name) + ">";
    }
    return "";
}

std::string CppLiteral(const Literal &value, const Type &alias)
{
    const Type &type = Unalias(alias);
    const bool isFloat = type.What == Type::Kind::Primitive &&
                         (type.Scalar == Primitive::Float || type.Scalar == Primitive::Double);
    if (const auto *flag = std::get_if<bool>(&value))
    {
        return *flag ? "true" : "false";
    }
    if (const auto *letter = std::get_if<char>(&value))
    {
        return IntegerText(Primitive::Char, *letter);
    }
    if (const auto *number = std::get_if<std::int64_t>(&value))
    {
        return isFloat ? FloatText(type.Scalar, static_cast<double>(*number))
                       : IntegerText(type.Scalar, *number);
    }
    if (const auto *number = std::get_if<std::uint64_t>(&value))
    {
        return isFloat ? FloatText(type.Scalar, static_cast<double>(*number))
                       : IntegerText(type.Scalar, static_cast<std::int64_t>(*number));
    }
    if (const auto *number = std::get_if<double>(&value))
    {
        return FloatText(type.Scalar, *number);
    }
    if (const auto *text = std::get_if<std::string>(&value))
    {
        return Quote(*text);
    }
    const auto &enumerator = std::get<EnumeratorValue>(value);
    return CppScopedName(enumerator.Enum->Scope, enumerator.Enum->Name) +
           "::" + enumerator.Enum->Enumerators[enumerator.Index].Name;
}

std::string CppLabel(std::int64_t value, const Type &alias)
{
    const Type &type = Unalias(alias);
    if (type.What == Type::Kind::Primitive)
    {
        return IntegerText(type.Scalar, value);
    }
    const auto &definition = dynamic_cast<const EnumDefinition &>(*type.Named);
    for (const auto &enumerator : definition.Enumerators)
    {
        if (enumerator.Value == static_cast<std::uint32_t>(value))
        {
            return CppScopedName(definition.Scope, definition.Name) + "::" + enumerator.Name;
        }
    }
    return "";
}

std::string Initializer(const Member &member)
{
    const Type &type = Unalias(member.Type);
    if (member.Default)
    {
        return " = " + CppLiteral(*member.Default, type);
    }
    if (type.What == Type::Kind::Primitive)
    {
        switch (type.Scalar)
        {
            case Primitive::Bool:
                return " = false";
            case Primitive::Float:
                return " = 0.0F";
            case Primitive::Double:
                return " = 0.0";
            case Primitive::Char:
                return " = '\\0'";
            default:
                return " = 0";
        }
    }
    if (type.What == Type::Kind::Named)
    {
        if (const auto *definition = dynamic_cast<const EnumDefinition *>(type.Named))
        {
            return " = " + CppScopedName(definition->Scope, definition->Name) +
                   "::" + definition->Enumerators[definition->Default].Name;
        }
    }
    const std::string maker = MakerOf(type);
    if (!maker.empty())
    {
        return " = " + maker + "::Make()";
    }
    return type.What == Type::Kind::Array || type.What == Type::Kind::Named ? "{}" : "";
}

bool IsSmall(const Type &alias)
{
    const Type &type = Unalias(alias);
    if (type.What == Type::Kind::Primitive)
    {
        return true;
    }
    return type.What == Type::Kind::Named && (dynamic_cast<const EnumDefinition *>(type.Named) != nullptr ||
                                              dynamic_cast<const BitmaskDefinition *>(type.Named) != nullptr);
}

}  // namespace RabitIdl
