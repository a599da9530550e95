#include "dynamic/ShapeBuilder.h"

#include <rabit/idl/NearestWord.h>

#include "dynamic/Limits.h"
#include "model/Names.h"
#include "model/RosTypeHash.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <set>
#include <string_view>

namespace Rabit::Dynamic
{
namespace
{

// Sums and products of sizes are capped at Huge, so that no text makes them overflow.
constexpr std::uint64_t Huge = std::uint64_t{1} << 60;
std::uint64_t Sum(std::uint64_t a, std::uint64_t b)
{
    return std::min(Huge, a + b);
}
std::uint64_t Product(std::uint64_t a, std::uint64_t b)
{
    return b != 0 && a > Huge / b ? Huge : a * b;
}

unsigned SizeOfNumber(unsigned bitBound)
{
    return bitBound <= 8 ? 1 : bitBound <= 16 ? 2 : bitBound <= 32 ? 4 : 8;
}

Kind KindOf(RabitIdl::Primitive primitive)
{
    // Both enumerations have the same order.
    return static_cast<Kind>(primitive);
}
static_assert(static_cast<int>(Kind::Double) == static_cast<int>(RabitIdl::Primitive::Double));
static_assert(static_cast<int>(Kind::Octet) == static_cast<int>(RabitIdl::Primitive::Octet));

Shape OfPrimitive(RabitIdl::Primitive primitive)
{
    Shape shape;
    shape.What = KindOf(primitive);
    shape.Size = RabitIdl::SizeOf(primitive);
    shape.MinSize = shape.Size;
    shape.FreshSize = 2 * shape.Size - 1;
    return shape;
}

// Refuses equal names, which JSON could not tell apart. The parser does not notice if a member has the name
// of an enclosing module.
template <typename Named>
void RefuseTwice(const std::vector<Named> &all)
{
    std::set<std::string_view> names;
    for (const Named &one : all)
    {
        if (!names.insert(one.Name).second)
        {
            throw Refused("'" + one.Name + "' is there twice");
        }
    }
}

Shape OfEnum(const RabitIdl::EnumDefinition &definition)
{
    Shape shape;
    shape.What = Kind::Enum;
    shape.Size = SizeOfNumber(definition.BitBound);
    for (const auto &enumerator : definition.Enumerators)
    {
        shape.Names.push_back({enumerator.Name, enumerator.Value});
    }
    shape.Start = shape.Names.at(definition.Default).Number;
    std::stable_sort(shape.Names.begin(), shape.Names.end(),
                     [](const NamedNumber &a, const NamedNumber &b) { return a.Number < b.Number; });
    return shape;
}

Shape OfBitmask(const RabitIdl::BitmaskDefinition &definition)
{
    Shape shape;
    shape.What = Kind::Bitmask;
    shape.Size = SizeOfNumber(definition.BitBound);
    for (const auto &bit : definition.Bits)
    {
        if (bit.Position >= 64)
        {
            throw Refused("bit '" + bit.Name + "' is beyond the 64th");
        }
        const std::uint64_t mask = std::uint64_t{1} << bit.Position;
        shape.Names.push_back({bit.Name, mask});
        shape.AllBits |= mask;
    }
    return shape;
}

std::uint64_t DefaultBits(const RabitIdl::Literal &value, const Shape &type)
{
    return std::visit(
        [&](const auto &one) -> std::uint64_t
        {
            using T = std::decay_t<decltype(one)>;
            if constexpr (std::is_arithmetic_v<T>)
            {
                if (type.What == Kind::Float)
                {
                    return std::bit_cast<std::uint32_t>(static_cast<float>(one));
                }
                if (type.What == Kind::Double)
                {
                    return std::bit_cast<std::uint64_t>(static_cast<double>(one));
                }
                if constexpr (!std::is_floating_point_v<T>)
                {
                    return type.What == Kind::Bool ? one != 0 : static_cast<std::uint64_t>(one);
                }
            }
            throw Refused("a @default is not of its member's type");
        },
        value);
}

void ReadPart(Part &part, const RabitIdl::Member &member, const Shape &type)
{
    part.Name = member.Name;
    part.Quoted = "\"" + member.Name + "\":";
    part.Type = &type;
    part.Key = member.Key;
    if (member.Default)
    {
        part.HasDefault = true;
        if (const auto *text = std::get_if<std::string>(member.Default.get()))
        {
            part.DefaultText = *text;
        }
        else
        {
            part.DefaultNumber = DefaultBits(*member.Default, type);
        }
    }
}

// The largest end offset of a key, or of a part of it, that starts at an offset. Any value above 16 means
// more than 16 bytes.
std::uint64_t KeyEnd(const Shape &type, std::uint64_t start)
{
    constexpr std::uint64_t tooFar = 17;
    switch (type.What)
    {
        case Kind::String:
            return type.Bound == 0 ? tooFar : (start + 3) / 4 * 4 + 4 + type.Bound + 1;
        case Kind::Sequence:
        case Kind::Union:
            return tooFar;  // the reader refuses these types as keys
        case Kind::Array:
            for (std::uint32_t i = 0; i < type.Length && start < tooFar; ++i)
            {
                start = KeyEnd(*type.Element, start);
            }
            return start;
        case Kind::Struct:
            for (const Part &part : type.Parts)
            {
                if (start < tooFar && (part.Key || !type.HasKey))
                {
                    start = KeyEnd(*part.Type, start);
                }
            }
            return start;
        default:
            return (start + type.Size - 1) / type.Size * type.Size + type.Size;
    }
}

}  // namespace

std::unique_ptr<const Shapes> ShapeBuilder::Build(const std::string &name)
{
    std::vector<std::string> messages;
    for (const auto &definition : _model.Definitions)
    {
        if (dynamic_cast<const RabitIdl::ConstDefinition *>(definition.get()) == nullptr &&
            dynamic_cast<const RabitIdl::TypedefDefinition *>(definition.get()) == nullptr)
        {
            _known[definition.get()] = Keep(OfDefinition(*definition));
        }
        const auto *structure = dynamic_cast<const RabitIdl::StructDefinition *>(definition.get());
        if (structure != nullptr && RabitIdl::IsMessage(*structure))
        {
            messages.push_back(RabitIdl::ScopedName(structure->Scope, structure->Name));
        }
        if (structure != nullptr && RabitIdl::ScopedName(structure->Scope, structure->Name) == name)
        {
            if (!RabitIdl::IsMessage(*structure))
            {
                throw Refused("'" + name + "' is @nested: no message");
            }
            _shapes->Root = _known.at(structure);
            _shapes->RosTypeHash = RabitIdl::RosTypeHash(*structure);
        }
    }
    if (_shapes->Root == nullptr)
    {
        throw Refused("the text defines no message '" + name + "'" + NearestWordHint(name, messages));
    }
    _shapes->KeyFitsHash = _shapes->Root->HasKey && KeyEnd(*_shapes->Root, 0) <= 16;
    return std::move(_shapes);
}

const Shape *ShapeBuilder::Keep(Shape shape)
{
    if (shape.Depth > MaxDepth)
    {
        throw Refused("types are nested more than " + std::to_string(MaxDepth) + " deep");
    }
    if (shape.FreshSize > MaxFreshSize)
    {
        throw Refused((shape.Name.empty() ? "an array" : "'" + shape.Name + "'") + " takes more than " +
                      std::to_string(MaxFreshSize) + " bytes");
    }
    _shapes->All.push_back(std::move(shape));
    return &_shapes->All.back();
}

const Shape *ShapeBuilder::Of(const RabitIdl::Type &alias)
{
    const RabitIdl::Type &type = RabitIdl::Unalias(alias);
    Shape shape;
    switch (type.What)
    {
        case RabitIdl::Type::Kind::Primitive:
            shape = OfPrimitive(type.Scalar);
            break;
        case RabitIdl::Type::Kind::String:
            shape.What = Kind::String;
            shape.Bound = type.Bound;
            shape.MinSize = 5;
            shape.FreshSize = 3 + 5;
            break;
        case RabitIdl::Type::Kind::Sequence:
            shape.What = Kind::Sequence;
            shape.Bound = type.Bound;
            shape.Element = Of(*type.Element);
            shape.MinSize = 4;
            shape.FreshSize = 3 + 4;
            shape.Depth = shape.Element->Depth + 1;
            break;
        case RabitIdl::Type::Kind::Array:
            shape.What = Kind::Array;
            shape.Length = type.Length;
            shape.Element = Of(*type.Element);
            shape.MinSize = Product(type.Length, shape.Element->MinSize);
            shape.FreshSize = Product(type.Length, shape.Element->FreshSize);
            shape.Depth = shape.Element->Depth + 1;
            break;
        case RabitIdl::Type::Kind::Named:
            return _known.at(type.Named);
    }
    return Keep(std::move(shape));
}

Shape ShapeBuilder::OfDefinition(const RabitIdl::Definition &definition)
{
    Shape shape;
    if (const auto *enumeration = dynamic_cast<const RabitIdl::EnumDefinition *>(&definition))
    {
        shape = OfEnum(*enumeration);
    }
    else if (const auto *bitmask = dynamic_cast<const RabitIdl::BitmaskDefinition *>(&definition))
    {
        shape = OfBitmask(*bitmask);
    }
    else if (const auto *choice = dynamic_cast<const RabitIdl::UnionDefinition *>(&definition))
    {
        shape = OfUnion(*choice);
    }
    else
    {
        shape = OfStruct(dynamic_cast<const RabitIdl::StructDefinition &>(definition));
    }
    RefuseTwice(shape.Parts);
    RefuseTwice(shape.Names);
    shape.Name = RabitIdl::ScopedName(definition.Scope, definition.Name);
    if (shape.What == Kind::Enum || shape.What == Kind::Bitmask)
    {
        shape.MinSize = shape.Size;
        shape.FreshSize = 2 * shape.Size - 1;
    }
    return shape;
}

Shape ShapeBuilder::OfStruct(const RabitIdl::StructDefinition &definition)
{
    Shape shape;
    shape.What = Kind::Struct;
    shape.HasKey = RabitIdl::HasKey(definition);
    for (const RabitIdl::Member *member : RabitIdl::AllMembers(definition))
    {
        const Shape &type = *Of(member->Type);
        ReadPart(shape.Parts.emplace_back(), *member, type);
        shape.MinSize = Sum(shape.MinSize, type.MinSize);
        shape.FreshSize = Sum(shape.FreshSize, Sum(type.FreshSize, shape.Parts.back().DefaultText.size()));
        shape.Depth = std::max(shape.Depth, type.Depth + 1);
    }
    return shape;
}

Shape ShapeBuilder::OfUnion(const RabitIdl::UnionDefinition &definition)
{
    Shape shape;
    shape.What = Kind::Union;
    shape.Discriminator = Of(definition.Discriminator);
    shape.OtherCase = definition.HasUnusedValue ? NoCase : NotAllowed;
    std::uint64_t least = definition.HasUnusedValue ? 0 : Huge;
    for (const RabitIdl::Case &item : definition.Cases)
    {
        const int place = static_cast<int>(shape.Parts.size());
        const Shape &type = *Of(item.Content.Type);
        Part &part = shape.Parts.emplace_back();
        ReadPart(part, item.Content, type);
        part.Label = item.Labels.empty() ? definition.UnusedValue : item.Labels.front();
        for (const std::int64_t label : item.Labels)
        {
            shape.Labels.emplace_back(label, place);
        }
        if (item.Default)
        {
            shape.OtherCase = place;
        }
        least = std::min(least, type.MinSize);
        // The largest of all cases, not that of the first: JSON may select any case.
        shape.FreshSize = std::max(shape.FreshSize, type.FreshSize);
        shape.Depth = std::max(shape.Depth, type.Depth + 1);
    }
    std::sort(shape.Labels.begin(), shape.Labels.end());
    shape.MinSize = Sum(shape.Discriminator->MinSize, least);
    shape.FreshSize = Sum(shape.FreshSize, shape.Discriminator->FreshSize);
    return shape;
}

}  // namespace Rabit::Dynamic
