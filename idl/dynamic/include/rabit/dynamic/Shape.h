// A type at run time, ready for use: names resolved, typedefs followed, bases' members first, sizes known.
// Made by ShapeBuilder, then immutable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace Rabit::Dynamic
{

enum class Kind : std::uint8_t
{
    Bool,
    Char,
    Octet,
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Int64,
    Uint64,
    Float,
    Double,
    String,
    Sequence,
    Array,
    Enum,
    Bitmask,
    Struct,
    Union
};

struct Shape;

// A member of a struct, or a case of a union.
struct Part
{
    std::string Name;
    std::string Quoted;  // `"name":`, for JSON
    const Shape *Type = nullptr;
    bool Key = false;
    bool HasDefault = false;  // @default: Text of a string, else Number, the value's bits
    std::uint64_t DefaultNumber = 0;
    std::string DefaultText;
    std::int64_t Label = 0;  // of a case: the discriminator that setting it gives
};

struct NamedNumber
{
    std::string Name;
    std::uint64_t Number = 0;  // of an enumerator; of a bit: its mask
};

// Results of CaseOf for a discriminator that selects no case.
inline constexpr int NoCase = -1;  // allowed, selects nothing
inline constexpr int NotAllowed = -2;

struct Shape
{
    Kind What = Kind::Bool;
    unsigned Size = 0;               // of a primitive, an enum or a bitmask, in bytes
    std::uint32_t Bound = 0;         // of a string or sequence, 0: none
    std::uint32_t Length = 0;        // of an array
    const Shape *Element = nullptr;  // of an array or sequence
    std::string Name;                // of a definition
    std::vector<Part> Parts;         // members of a struct, cases of a union
    bool HasKey = false;             // of a struct: some members have @key
    std::vector<NamedNumber> Names;  // of an enum in order of value, of a bitmask in order of declaration
    std::uint64_t Start = 0;         // of an enum: the value of a new one
    std::uint64_t AllBits = 0;       // of a bitmask
    const Shape *Discriminator = nullptr;
    std::vector<std::pair<std::int64_t, int>> Labels;  // of a union: label and case, sorted
    int OtherCase = NotAllowed;                        // of a union: the case of all other labels

    unsigned Depth = 1;           // types within types, itself counted
    std::uint64_t MinSize = 0;    // fewest bytes of any value, alignment not counted
    std::uint64_t FreshSize = 0;  // most bytes of a new value, whatever its alignment
};

struct Shapes
{
    std::deque<Shape> All;        // places do not change
    const Shape *Root = nullptr;  // a struct
    bool KeyFitsHash = false;     // no key takes more than 16 bytes
    std::string RosTypeHash;      // MessageType::RosTypeHash of the root
};

// The name of an enumerator, or null.
const NamedNumber *EnumeratorOf(const Shape &shape, std::uint64_t value);
// The case that a discriminator selects: its place, NoCase or NotAllowed.
int CaseOf(const Shape &shape, std::int64_t label);

}  // namespace Rabit::Dynamic
