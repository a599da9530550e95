// The definitions of an IDL file, in the order of the file, with every name resolved. ModelReader fills it;
// the emitters only read it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace RabitIdl
{

enum class Primitive
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
    Double
};

// Bytes of a primitive in memory and on the wire; also its alignment on the wire.
unsigned SizeOf(Primitive primitive);

struct Definition;

// A type as it is used: by a member, an element, a typedef.
struct Type
{
    enum class Kind
    {
        Primitive,
        String,
        Sequence,
        Array,
        Named
    };
    Kind What = Kind::Primitive;
    RabitIdl::Primitive Scalar = RabitIdl::Primitive::Bool;
    std::uint32_t Bound = 0;              // of a string or sequence; 0: none
    std::uint32_t Length = 0;             // of an array
    std::shared_ptr<const Type> Element;  // of a sequence or array
    const Definition *Named = nullptr;
};

struct EnumDefinition;

// The value of an enumerator, by its place in the enumeration.
struct EnumeratorValue
{
    const EnumDefinition *Enum = nullptr;
    std::size_t Index = 0;
};

// A value of a constant or a @default.
using Literal = std::variant<bool, char, std::int64_t, std::uint64_t, double, std::string, EnumeratorValue>;

struct Definition
{
    virtual ~Definition() = default;
    std::vector<std::string> Scope;  // the modules around it, outermost first
    std::string Name;
    std::string File;
    std::uint32_t Line = 0;
    bool InMainFile = false;           // false: from an included file, whose own header defines it
    std::vector<std::string> Comment;  // lines for people
};

struct Member
{
    std::string Name;
    RabitIdl::Type Type;
    bool Key = false;
    std::uint32_t Id = 0;
    std::string Unit;
    std::vector<std::string> Comment;  // lines for people
    std::unique_ptr<Literal> Default;
    std::string File;
    std::uint32_t Line = 0;
};

struct StructDefinition : Definition
{
    const StructDefinition *Base = nullptr;
    bool Nested = false;      // a plain struct; otherwise a message
    bool Appendable = false;  // encoded as a final one
    std::vector<Member> Members;
};

struct Case
{
    std::vector<std::int64_t> Labels;  // without `default:`
    bool Default = false;              // has the label `default:`
    Member Content;
};

struct UnionDefinition : Definition
{
    bool Appendable = false;
    RabitIdl::Type Discriminator;
    std::vector<Case> Cases;
    bool HasDefaultCase = false;
    bool HasUnusedValue = false;   // no default case, and a discriminator may have a value without a case
    std::int64_t UnusedValue = 0;  // one such value; with a default case, one that selects it
};

struct EnumDefinition : Definition
{
    struct Enumerator
    {
        std::string Name;
        std::uint32_t Value = 0;
        std::vector<std::string> Comment;
    };
    std::vector<Enumerator> Enumerators;
    std::size_t Default = 0;
    unsigned BitBound = 32;
};

struct BitmaskDefinition : Definition
{
    struct Bit
    {
        std::string Name;
        unsigned Position = 0;
        std::vector<std::string> Comment;
    };
    std::vector<Bit> Bits;
    unsigned BitBound = 32;
};

struct TypedefDefinition : Definition
{
    RabitIdl::Type Type;
    bool InIdlOnly = false;  // its name is reserved in C++, so the C++ code uses its target instead
};

struct ConstDefinition : Definition
{
    RabitIdl::Type Type;
    Literal Value;
};

struct Model
{
    std::string MainFile;               // its name, for instance `uav.idl`; with directories if it is below
                                        // the reader's base
    std::vector<std::string> Includes;  // files that the main file includes itself, likewise
    std::vector<std::string> AllPaths;  // every file read, with its path
    std::vector<std::unique_ptr<Definition>> Definitions;
};

// The definition that a type names once typedefs are followed, or null; and the type itself.
const Type &Unalias(const Type &type);
// A struct's own members and those of its bases, bases first.
std::vector<const Member *> AllMembers(const StructDefinition &definition);
// True if a struct or one of its bases has @key members.
bool HasKey(const StructDefinition &definition);
// The members that make up the key of a struct: those with @key or, if there are none, all.
std::vector<const Member *> KeyMembers(const StructDefinition &definition);
// True if the struct or one of its bases is a message.
bool IsMessage(const StructDefinition &definition);

}  // namespace RabitIdl
