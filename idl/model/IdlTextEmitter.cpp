#include "model/IdlTextEmitter.h"

#include "model/LiteralText.h"
#include "model/Names.h"
#include "model/TextBuilder.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace RabitIdl
{
namespace
{

std::string IdlName(const std::string &name)
{
    return IsIdlKeyword(name) ? "_" + name : name;
}

std::string Lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return text;
}

// Names that are declared in an inner scope, in lower case. A scoped name that begins with one of them
// would be ambiguous, and gets `::` before it. Other names get no `::`, for readers that do not support it.
using Inner = std::set<std::string>;

void AddNames(const Definition &definition, Inner &inner)
{
    const bool isOutermost = definition.Scope.empty();
    for (std::size_t i = 1; i < definition.Scope.size(); ++i)
    {
        inner.insert(Lower(definition.Scope[i]));
    }
    const auto add = [&](const std::string &name, bool always)
    {
        if (always || !isOutermost)
        {
            inner.insert(Lower(name));
        }
    };
    add(definition.Name, false);
    if (const auto *structure = dynamic_cast<const StructDefinition *>(&definition))
    {
        for (const Member *member : AllMembers(*structure))
        {
            add(member->Name, true);
        }
    }
    else if (const auto *choice = dynamic_cast<const UnionDefinition *>(&definition))
    {
        for (const Case &item : choice->Cases)
        {
            add(item.Content.Name, true);
        }
    }
    else if (const auto *enumeration = dynamic_cast<const EnumDefinition *>(&definition))
    {
        for (const auto &enumerator : enumeration->Enumerators)
        {
            add(enumerator.Name, false);
        }
    }
    else if (const auto *bitmask = dynamic_cast<const BitmaskDefinition *>(&definition))
    {
        for (const auto &bit : bitmask->Bits)
        {
            add(bit.Name, true);
        }
    }
}

std::string IdlScopedName(const Definition &definition, const Inner &inner)
{
    const std::string &first = definition.Scope.empty() ? definition.Name : definition.Scope.front();
    std::string text = inner.count(Lower(first)) != 0 ? "::" : "";
    for (const std::string &part : definition.Scope)
    {
        text += IdlName(part) + "::";
    }
    return text + IdlName(definition.Name);
}

std::string IdlPrimitive(Primitive primitive)
{
    switch (primitive)
    {
        case Primitive::Bool:
            return "boolean";
        case Primitive::Char:
            return "char";
        case Primitive::Octet:
            return "octet";
        case Primitive::Int8:
            return "int8";
        case Primitive::Uint8:
            return "uint8";
        case Primitive::Int16:
            return "short";
        case Primitive::Uint16:
            return "unsigned short";
        case Primitive::Int32:
            return "long";
        case Primitive::Uint32:
            return "unsigned long";
        case Primitive::Int64:
            return "long long";
        case Primitive::Uint64:
            return "unsigned long long";
        case Primitive::Float:
            return "float";
        case Primitive::Double:
            return "double";
    }
    return "";
}

// An array's element; its dimensions go behind the declared name.
const Type &WithoutDimensions(const Type &type)
{
    return type.What == Type::Kind::Array ? WithoutDimensions(*type.Element) : type;
}

std::string Dimensions(const Type &type)
{
    return type.What == Type::Kind::Array
               ? "[" + std::to_string(type.Length) + "]" + Dimensions(*type.Element)
               : "";
}

std::string IdlType(const Type &type, const Inner &inner)
{
    switch (type.What)
    {
        case Type::Kind::Primitive:
            return IdlPrimitive(type.Scalar);
        case Type::Kind::String:
            return type.Bound == 0 ? "string" : "string<" + std::to_string(type.Bound) + ">";
        case Type::Kind::Sequence:
            // The blank keeps two closing brackets apart.
            return "sequence<" + IdlType(*type.Element, inner) +
                   (type.Bound == 0 ? " >" : ", " + std::to_string(type.Bound) + ">");
        case Type::Kind::Array:
            return "";
        case Type::Kind::Named:
            return IdlScopedName(*type.Named, inner);
    }
    return "";
}

std::string Declaration(const Type &type, const std::string &name, const Inner &inner)
{
    return IdlType(WithoutDimensions(type), inner) + " " + IdlName(name) + Dimensions(type) + ";";
}

std::string IdlLiteral(const Literal &value)
{
    if (const auto *flag = std::get_if<bool>(&value))
    {
        return *flag ? "TRUE" : "FALSE";
    }
    if (const auto *letter = std::get_if<char>(&value))
    {
        const std::string quoted = Quote(std::string(1, *letter));
        return *letter == '\'' ? "'\\''" : "'" + quoted.substr(1, quoted.size() - 2) + "'";
    }
    if (const auto *number = std::get_if<std::int64_t>(&value))
    {
        return std::to_string(*number);
    }
    if (const auto *number = std::get_if<std::uint64_t>(&value))
    {
        return std::to_string(*number);
    }
    if (const auto *number = std::get_if<double>(&value))
    {
        return Number(*number);
    }
    return Quote(std::get<std::string>(value));
}

std::string IdlLabel(std::int64_t value, const Type &alias, const Inner &inner)
{
    const Type &type = Unalias(alias);
    if (type.What == Type::Kind::Named)
    {
        const auto &definition = dynamic_cast<const EnumDefinition &>(*type.Named);
        for (const auto &enumerator : definition.Enumerators)
        {
            if (enumerator.Value == static_cast<std::uint32_t>(value))
            {
                Definition place;
                place.Scope = definition.Scope;
                place.Name = enumerator.Name;
                return IdlScopedName(place, inner);
            }
        }
    }
    switch (type.Scalar)
    {
        case Primitive::Bool:
            return value != 0 ? "TRUE" : "FALSE";
        case Primitive::Char:
            return IdlLiteral(static_cast<char>(value));
        case Primitive::Uint64:
            return std::to_string(static_cast<std::uint64_t>(value));
        default:
            return std::to_string(value);
    }
}

void Collect(const Definition &definition, std::set<const Definition *> &used);

void Collect(const Type &type, std::set<const Definition *> &used)
{
    if (type.Element)
    {
        Collect(*type.Element, used);
    }
    if (type.Named != nullptr)
    {
        Collect(*type.Named, used);
    }
}

void Collect(const Definition &definition, std::set<const Definition *> &used)
{
    if (!used.insert(&definition).second)
    {
        return;
    }
    if (const auto *structure = dynamic_cast<const StructDefinition *>(&definition))
    {
        for (const Member *member : AllMembers(*structure))
        {
            Collect(member->Type, used);
        }
    }
    else if (const auto *choice = dynamic_cast<const UnionDefinition *>(&definition))
    {
        Collect(choice->Discriminator, used);
        for (const Case &item : choice->Cases)
        {
            Collect(item.Content.Type, used);
        }
    }
    else if (const auto *alias = dynamic_cast<const TypedefDefinition *>(&definition))
    {
        Collect(alias->Type, used);
    }
}

void EmitStruct(TextBuilder &out, const StructDefinition &definition, const Inner &inner)
{
    out.Line(std::string(definition.Appendable ? "@appendable" : "@final") +
             (definition.Nested ? " @nested" : ""));
    out.Line("struct " + IdlName(definition.Name) + " {");
    out.Indent();
    for (const Member *member : AllMembers(definition))
    {
        out.Line((member->Key ? "@key " : "") +
                 (member->Default ? "@default(" + IdlLiteral(*member->Default) + ") " : "") +
                 Declaration(member->Type, member->Name, inner));
    }
    out.Outdent();
    out.Line("};");
}

void EmitUnion(TextBuilder &out, const UnionDefinition &definition, const Inner &inner)
{
    out.Line(definition.Appendable ? "@appendable" : "@final");
    out.Line("union " + IdlName(definition.Name) + " switch (" + IdlType(definition.Discriminator, inner) +
             ") {");
    for (const Case &item : definition.Cases)
    {
        for (const std::int64_t label : item.Labels)
        {
            out.Line("case " + IdlLabel(label, definition.Discriminator, inner) + ":");
        }
        if (item.Default)
        {
            out.Line("default:");
        }
        out.Indent();
        out.Line(Declaration(item.Content.Type, item.Content.Name, inner));
        out.Outdent();
    }
    out.Line("};");
}

void EmitEnum(TextBuilder &out, const EnumDefinition &definition)
{
    if (definition.BitBound != 32)
    {
        out.Line("@bit_bound(" + std::to_string(definition.BitBound) + ")");
    }
    out.Line("enum " + IdlName(definition.Name) + " {");
    out.Indent();
    for (std::size_t i = 0; i < definition.Enumerators.size(); ++i)
    {
        const std::uint32_t value = definition.Enumerators[i].Value;
        const bool follows = value == (i == 0 ? 0 : definition.Enumerators[i - 1].Value + 1);
        out.Line((follows ? "" : "@value(" + std::to_string(value) + ") ") +
                 (i == definition.Default && i != 0 ? "@default_literal " : "") +
                 IdlName(definition.Enumerators[i].Name) +
                 (i + 1 == definition.Enumerators.size() ? "" : ","));
    }
    out.Outdent();
    out.Line("};");
}

void EmitBitmask(TextBuilder &out, const BitmaskDefinition &definition)
{
    out.Line("@bit_bound(" + std::to_string(definition.BitBound) + ")");
    out.Line("bitmask " + IdlName(definition.Name) + " {");
    out.Indent();
    for (std::size_t i = 0; i < definition.Bits.size(); ++i)
    {
        const unsigned position = definition.Bits[i].Position;
        const bool follows = position == (i == 0 ? 0 : definition.Bits[i - 1].Position + 1);
        out.Line((follows ? "" : "@position(" + std::to_string(position) + ") ") +
                 IdlName(definition.Bits[i].Name) + (i + 1 == definition.Bits.size() ? "" : ","));
    }
    out.Outdent();
    out.Line("};");
}

void EmitDefinition(TextBuilder &out, const Definition &definition, const Inner &inner)
{
    if (const auto *structure = dynamic_cast<const StructDefinition *>(&definition))
    {
        EmitStruct(out, *structure, inner);
    }
    else if (const auto *choice = dynamic_cast<const UnionDefinition *>(&definition))
    {
        EmitUnion(out, *choice, inner);
    }
    else if (const auto *enumeration = dynamic_cast<const EnumDefinition *>(&definition))
    {
        EmitEnum(out, *enumeration);
    }
    else if (const auto *bitmask = dynamic_cast<const BitmaskDefinition *>(&definition))
    {
        EmitBitmask(out, *bitmask);
    }
    else if (const auto *alias = dynamic_cast<const TypedefDefinition *>(&definition))
    {
        out.Line("typedef " + Declaration(alias->Type, alias->Name, inner));
    }
}

}  // namespace

std::string EmitIdlText(const Model &model, const StructDefinition &definition)
{
    std::set<const Definition *> used;
    Collect(definition, used);
    Inner inner;
    for (const Definition *item : used)
    {
        AddNames(*item, inner);
    }
    TextBuilder out;
    for (const auto &item : model.Definitions)
    {
        if (used.count(item.get()) == 0)
        {
            continue;
        }
        std::string opening;
        std::string closing;
        for (const std::string &part : item->Scope)
        {
            opening += (opening.empty() ? "module " : " module ") + IdlName(part) + " {";
            closing += closing.empty() ? "};" : " };";
        }
        if (!opening.empty())
        {
            out.Line(opening);
        }
        EmitDefinition(out, *item, inner);
        if (!closing.empty())
        {
            out.Line(closing);
        }
    }
    return out.Text();
}

}  // namespace RabitIdl
