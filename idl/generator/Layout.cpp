#include "Layout.h"

#include <algorithm>
#include <array>

namespace RabitIdl
{
namespace
{

using Offset = std::optional<std::uint64_t>;

std::uint64_t Aligned(std::uint64_t offset, std::uint64_t alignment)
{
    return (offset + alignment - 1) / alignment * alignment;
}

unsigned EnumSize(unsigned bitBound)
{
    return bitBound <= 8 ? 1 : bitBound <= 16 ? 2 : 4;
}

unsigned BitmaskSize(unsigned bitBound)
{
    return bitBound <= 32 ? EnumSize(bitBound) : 8;
}

// For the largest end offset of a value that starts at an offset. Fixed: nothing if the ends of values
// differ. Bounded: nothing if there is no largest end.
enum class Only
{
    Fixed,
    Bounded
};

Offset End(const Type &type, std::uint64_t start, Only only, bool keysOnly);

Offset EndOfMembers(const StructDefinition &definition, std::uint64_t start, Only only, bool keysOnly)
{
    const bool someKeys = HasKey(definition);
    Offset end = start;
    for (const Member *member : AllMembers(definition))
    {
        if (keysOnly && someKeys && !member->Key)
        {
            continue;
        }
        end = End(member->Type, *end, only, keysOnly);
        if (!end)
        {
            break;
        }
    }
    return end;
}

// The size of an element depends only on its start modulo 8, so the pattern repeats after at most 8
// elements.
Offset EndOfArray(const Type &element, std::uint64_t count, std::uint64_t start, Only only, bool keysOnly)
{
    std::array<std::uint64_t, 8> seenCount{};
    std::array<std::uint64_t, 8> seenOffset{};
    std::array<bool, 8> seen{};
    std::uint64_t offset = start;
    for (std::uint64_t i = 0; i < count; ++i)
    {
        const std::size_t phase = offset % 8;
        if (seen[phase])
        {
            const std::uint64_t period = i - seenCount[phase];
            const std::uint64_t growth = offset - seenOffset[phase];
            const std::uint64_t cycles = (count - i) / period;
            offset += cycles * growth;
            i += cycles * period;
            seen.fill(false);
            if (i == count)
            {
                break;
            }
        }
        seen[offset % 8] = true;
        seenCount[offset % 8] = i;
        seenOffset[offset % 8] = offset;
        const Offset end = End(element, offset, only, keysOnly);
        if (!end)
        {
            return end;
        }
        offset = *end;
    }
    return offset;
}

Offset EndOfUnion(const UnionDefinition &definition, std::uint64_t start, Only only)
{
    const Offset begin = End(definition.Discriminator, start, only, false);
    Offset farthest = begin;
    Offset nearest;
    for (const Case &item : definition.Cases)
    {
        const Offset end = End(item.Content.Type, *begin, only, false);
        if (!end)
        {
            return end;
        }
        farthest = std::max(*farthest, *end);
        nearest = nearest ? std::min(*nearest, *end) : end;
    }
    if (definition.HasUnusedValue)
    {
        nearest = begin;
    }
    return only == Only::Fixed && nearest != farthest ? Offset() : farthest;
}

Offset End(const Type &alias, std::uint64_t start, Only only, bool keysOnly)
{
    const Type &type = Unalias(alias);
    switch (type.What)
    {
        case Type::Kind::Primitive:
            return Aligned(start, SizeOf(type.Scalar)) + SizeOf(type.Scalar);
        case Type::Kind::String:
            return only == Only::Fixed || type.Bound == 0 ? Offset() : Aligned(start, 4) + 4 + type.Bound + 1;
        case Type::Kind::Sequence:
            return only == Only::Fixed || type.Bound == 0
                       ? Offset()
                       : EndOfArray(*type.Element, type.Bound, Aligned(start, 4) + 4, only, keysOnly);
        case Type::Kind::Array:
            return EndOfArray(*type.Element, type.Length, start, only, keysOnly);
        case Type::Kind::Named:
            break;
    }
    if (const auto *definition = dynamic_cast<const EnumDefinition *>(type.Named))
    {
        const unsigned size = EnumSize(definition->BitBound);
        return Aligned(start, size) + size;
    }
    if (const auto *definition = dynamic_cast<const BitmaskDefinition *>(type.Named))
    {
        const unsigned size = BitmaskSize(definition->BitBound);
        return Aligned(start, size) + size;
    }
    if (const auto *definition = dynamic_cast<const UnionDefinition *>(type.Named))
    {
        return EndOfUnion(*definition, start, only);
    }
    return EndOfMembers(dynamic_cast<const StructDefinition &>(*type.Named), start, only, keysOnly);
}

}  // namespace

std::uint64_t MinSize(const Definition &definition)
{
    if (const auto *enumeration = dynamic_cast<const EnumDefinition *>(&definition))
    {
        return EnumSize(enumeration->BitBound);
    }
    if (const auto *bitmask = dynamic_cast<const BitmaskDefinition *>(&definition))
    {
        return BitmaskSize(bitmask->BitBound);
    }
    if (const auto *choice = dynamic_cast<const UnionDefinition *>(&definition))
    {
        Offset least = choice->HasUnusedValue ? Offset(0) : Offset();
        for (const Case &item : choice->Cases)
        {
            const std::uint64_t size = MinSize(item.Content.Type);
            least = least ? std::min(*least, size) : size;
        }
        return MinSize(choice->Discriminator) + least.value_or(0);
    }
    std::uint64_t sum = 0;
    for (const Member *member : AllMembers(dynamic_cast<const StructDefinition &>(definition)))
    {
        sum += MinSize(member->Type);
    }
    return sum;
}

std::uint64_t MinSize(const Type &alias)
{
    const Type &type = Unalias(alias);
    switch (type.What)
    {
        case Type::Kind::Primitive:
            return SizeOf(type.Scalar);
        case Type::Kind::String:
            return 5;
        case Type::Kind::Sequence:
            return 4;
        case Type::Kind::Array:
            return type.Length * MinSize(*type.Element);
        case Type::Kind::Named:
            return MinSize(*type.Named);
    }
    return 0;
}

std::uint64_t FreshSize(const Definition &definition)
{
    if (const auto *choice = dynamic_cast<const UnionDefinition *>(&definition))
    {
        return FreshSize(choice->Cases.front().Content.Type);
    }
    std::uint64_t sum = 0;
    if (const auto *structure = dynamic_cast<const StructDefinition *>(&definition))
    {
        for (const Member *member : AllMembers(*structure))
        {
            const auto *text = member->Default ? std::get_if<std::string>(member->Default.get()) : nullptr;
            sum += text != nullptr ? text->size() + 1 : FreshSize(member->Type);
        }
    }
    return sum;
}

std::uint64_t FreshSize(const Type &alias)
{
    const Type &type = Unalias(alias);
    switch (type.What)
    {
        case Type::Kind::Array:
            return type.Length * FreshSize(*type.Element);
        case Type::Kind::Named:
            return FreshSize(*type.Named);
        default:
            return 0;
    }
}

std::optional<std::uint64_t> FixedSize(const StructDefinition &definition)
{
    return EndOfMembers(definition, 0, Only::Fixed, false);
}

std::optional<std::uint64_t> MaxKeySize(const StructDefinition &definition)
{
    return HasKey(definition) ? EndOfMembers(definition, 0, Only::Bounded, true) : 0;
}

}  // namespace RabitIdl
