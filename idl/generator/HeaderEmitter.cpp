#include "HeaderEmitter.h"

#include "CppText.h"
#include "Layout.h"
#include "UnionEmitter.h"
#include "model/Names.h"
#include "model/TextBuilder.h"

#include <algorithm>
#include <set>

namespace RabitIdl
{
namespace
{

std::string UnsignedOf(unsigned bitBound)
{
    return bitBound <= 8    ? "::std::uint8_t"
           : bitBound <= 16 ? "::std::uint16_t"
           : bitBound <= 32 ? "::std::uint32_t"
                            : "::std::uint64_t";
}

// Opens and closes namespaces, to match the scope of the next definition.
class Namespaces
{
public:
    explicit Namespaces(TextBuilder &text) : _text(text) {}
    ~Namespaces() { Enter({}); }
    Namespaces(const Namespaces &) = delete;
    Namespaces &operator=(const Namespaces &) = delete;

    void Enter(const std::vector<std::string> &scope)
    {
        if (scope == _scope)
        {
            return;
        }
        if (!_scope.empty())
        {
            _text.Line("}  // namespace " + Joined(_scope));
            _text.Line();
        }
        if (!scope.empty())
        {
            _text.Line("namespace " + Joined(scope));
            _text.Line("{");
            _text.Line();
        }
        _scope = scope;
    }

private:
    static std::string Joined(const std::vector<std::string> &scope)
    {
        std::string text;
        for (const std::string &part : scope)
        {
            text += (text.empty() ? "" : "::") + part;
        }
        return text;
    }

    TextBuilder &_text;
    std::vector<std::string> _scope;
};

// Declarations beside a type name it with its scope: a parameter may have the same name.
void EmitComparison(TextBuilder &out, const Definition &definition)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    out.Line("bool operator==(const " + name + " &a, const " + name + " &b);");
    out.Line("inline bool operator!=(const " + name + " &a, const " + name + " &b)");
    out.Open();
    out.Line("return !(a == b);");
    out.Close();
}

// The bound of a string or sequence; 0 if it has none.
std::uint32_t BoundOf(const Type &type)
{
    return Unalias(type).Bound;
}

void EmitMembers(TextBuilder &out, const StructDefinition &definition)
{
    const std::vector<const Member *> all = AllMembers(definition);
    for (const Member &member : definition.Members)
    {
        out.Comment(member.Comment);
        if (!member.Unit.empty())
        {
            out.Line("// Unit: " + member.Unit);
        }
        out.Line(CppType(member.Type) + " " + member.Name + Initializer(member) + ";");
        const std::string bound = member.Name + "_bound";
        const bool isFree =
            bound != definition.Name &&
            std::none_of(all.begin(), all.end(), [&](const Member *other) { return other->Name == bound; });
        if (BoundOf(member.Type) != 0 && isFree)
        {
            out.Line("static constexpr ::std::size_t " + bound + " = " +
                     std::to_string(BoundOf(member.Type)) + ";");
        }
    }
}

void EmitPlainStruct(TextBuilder &out, const StructDefinition &definition)
{
    const std::string base = definition.Base == nullptr ? ""
                                                        : " : public " + CppScopedName(definition.Base->Scope,
                                                                                       definition.Base->Name);
    out.Line("struct " + definition.Name + base);
    out.Open();
    EmitMembers(out, definition);
    out.Close(";");
    out.Line("// For people.");
    out.Line("::std::string ToString(const " + CppScopedName(definition.Scope, definition.Name) +
             " &value);");
    out.Line("// IEEE 754 comparison of floating point members: NaN is unlike everything.");
    EmitComparison(out, definition);
    out.Line();
}

void EmitMessage(TextBuilder &out, const StructDefinition &definition)
{
    std::string bases = "public ::Rabit::RabitMessage";
    if (definition.Base != nullptr)
    {
        const std::string base = "public " + CppScopedName(definition.Base->Scope, definition.Base->Name);
        bases = IsMessage(*definition.Base) ? base : bases + ", " + base;
    }
    out.Line("class " + definition.Name + " : " + bases);
    out.Open();
    out.Label("public:");
    EmitMembers(out, definition);
    out.Line();
    out.Line("// What is known of " + ScopedName(definition.Scope, definition.Name) + " at run time.");
    out.Line("static const ::Rabit::MessageType &IdlType();");
    out.Line();
    out.Line("::std::unique_ptr<::Rabit::RabitMessage> Clone() const override;");
    out.Line("bool CopyMessage(::Rabit::RabitMessage *msg) override;");
    out.Line("void Clear() override;");
    out.Line("::std::string ToString() const override;");
    out.Line("// The bytes of a DDS sample, as ::Rabit::MessageType has them. stype must be 0.");
    out.Line("int Serialize(::std::uint8_t *buf, int maxBufSize, int stype = 0) override;");
    out.Line("int DeSerialize(::std::uint8_t *buf, int len, int stype = 0) override;");
    out.Close(";");
    out.Line("// Compares the members above, not the time stamp. IEEE 754: NaN is unlike everything.");
    EmitComparison(out, definition);
    out.Line();
}

void EmitEnum(TextBuilder &out, const EnumDefinition &definition)
{
    out.Line("enum class " + definition.Name + " : " + UnsignedOf(definition.BitBound));
    out.Open();
    for (const auto &enumerator : definition.Enumerators)
    {
        out.Comment(enumerator.Comment);
        out.Line(enumerator.Name + " = " + std::to_string(enumerator.Value) + "U,");
    }
    out.Close(";");
    out.Line("// The enumerator's name, or the number if it is not declared.");
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    out.Line("::std::string ToString(" + name + " value);");
    out.Line("// The enumerator of that name. False, and nothing changed, if there is none.");
    out.Line("bool FromText(::std::string_view text, " + name + " &value);");
    out.Line();
}

void EmitBitmask(TextBuilder &out, const BitmaskDefinition &definition)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    const std::string bits = UnsignedOf(definition.BitBound);
    out.Line("enum class " + definition.Name + " : " + bits);
    out.Open();
    for (const auto &bit : definition.Bits)
    {
        out.Comment(bit.Comment);
        out.Line(bit.Name + " = " + std::to_string(1ULL << bit.Position) + "U" +
                 (definition.BitBound > 32 ? "LL" : "") + ",");
    }
    out.Close(";");
    const std::string wide = definition.BitBound > 32 ? "::std::uint64_t" : "::std::uint32_t";
    for (const char *sign : {"|", "&", "^"})
    {
        const std::string text = sign;
        out.Line("constexpr " + name + " operator" + text + "(" + name + " a, " + name + " b)");
        out.Open();
        out.Line("return static_cast<" + name + ">(static_cast<" + wide + ">(a) " + text + " static_cast<" +
                 wide + ">(b));");
        out.Close();
        out.Line("constexpr " + name + " &operator" + text + "=(" + name + " &a, " + name + " b)");
        out.Open();
        out.Line("return a = a " + text + " b;");
        out.Close();
    }
    unsigned long long all = 0;
    for (const auto &bit : definition.Bits)
    {
        all |= 1ULL << bit.Position;
    }
    out.Line("// All declared bits that are not set.");
    out.Line("constexpr " + name + " operator~(" + name + " a)");
    out.Open();
    out.Line("return static_cast<" + name + ">(~static_cast<" + wide + ">(a) & " + std::to_string(all) +
             (definition.BitBound > 32 ? "ULL" : "U") + ");");
    out.Close();
    out.Line("// Whether all of these bits are set.");
    out.Line("constexpr bool Has(" + name + " value, " + name + " bits)");
    out.Open();
    out.Line("return (value & bits) == bits;");
    out.Close();
    out.Line("// The names of the bits that are set, joined with `|`.");
    out.Line("::std::string ToString(" + name + " value);");
    out.Line("// The reverse; `0` is no bit. False, and nothing changed, if a name is not declared.");
    out.Line("bool FromText(::std::string_view text, " + name + " &value);");
    out.Line();
}

void EmitConst(TextBuilder &out, const ConstDefinition &definition)
{
    const Type &type = Unalias(definition.Type);
    const std::string cppType =
        type.What == Type::Kind::String ? "::std::string_view" : CppType(definition.Type);
    out.Line("inline constexpr " + cppType + " " + definition.Name + " = " +
             CppLiteral(definition.Value, type) + ";");
    out.Line();
}

// The scoped names of all definitions and modules.
std::set<std::string> NamesOf(const Model &model)
{
    std::set<std::string> names;
    for (const auto &definition : model.Definitions)
    {
        names.insert(ScopedName(definition->Scope, definition->Name));
        std::vector<std::string> scope = definition->Scope;
        while (!scope.empty())
        {
            const std::string module = scope.back();
            scope.pop_back();
            names.insert(ScopedName(scope, module));
        }
    }
    return names;
}

// `names`: those that are taken.
void EmitDefinition(TextBuilder &out, const Definition &definition, const std::set<std::string> &names)
{
    out.Comment(definition.Comment);
    if (const auto *structure = dynamic_cast<const StructDefinition *>(&definition))
    {
        IsMessage(*structure) ? EmitMessage(out, *structure) : EmitPlainStruct(out, *structure);
    }
    else if (const auto *choice = dynamic_cast<const UnionDefinition *>(&definition))
    {
        EmitUnionClass(out, *choice);
        EmitComparison(out, *choice);
        out.Line();
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
        if (alias->InIdlOnly)
        {
            return;
        }
        out.Line("using " + alias->Name + " = " + CppType(alias->Type) + ";");
        const std::string bound = alias->Name + "_bound";
        if (BoundOf(alias->Type) != 0 && names.count(ScopedName(alias->Scope, bound)) == 0)
        {
            out.Line("inline constexpr ::std::size_t " + bound + " = " +
                     std::to_string(BoundOf(alias->Type)) + ";");
        }
        out.Line();
    }
    else
    {
        EmitConst(out, dynamic_cast<const ConstDefinition &>(definition));
    }
}

void EmitCodecDeclaration(TextBuilder &out, const Definition &definition)
{
    if (dynamic_cast<const TypedefDefinition *>(&definition) != nullptr ||
        dynamic_cast<const ConstDefinition *>(&definition) != nullptr)
    {
        return;
    }
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    const auto *structure = dynamic_cast<const StructDefinition *>(&definition);
    const bool small = dynamic_cast<const EnumDefinition *>(&definition) != nullptr ||
                       dynamic_cast<const BitmaskDefinition *>(&definition) != nullptr;
    const std::string value = small ? name + " value" : "const " + name + " &value";
    out.Line("template <>");
    out.Line("struct Rabit::Idl::Codec<" + name + ">");
    out.Open();
    out.Line("static constexpr ::std::size_t MinSize = " + std::to_string(MinSize(definition)) + ";");
    if (!small)
    {
        out.Line("static constexpr ::std::size_t FreshSize = " + std::to_string(FreshSize(definition)) + ";");
    }
    if (structure != nullptr)
    {
        const std::optional<std::uint64_t> keySize = MaxKeySize(*structure);
        out.Line("static constexpr ::std::size_t FixedSize = " +
                 std::to_string(FixedSize(*structure).value_or(0)) + ";");
        out.Line(std::string("static constexpr bool HasKey = ") + (HasKey(*structure) ? "true;" : "false;"));
        out.Line(std::string("static constexpr bool KeyFitsHash = ") +
                 (keySize && *keySize <= 16 ? "true;" : "false;"));
    }
    out.Line("static bool Write(CdrWriter &writer, " + value + ");");
    out.Line("static bool Read(CdrReader &reader, " + name + " &value);");
    out.Line("static bool Scan(CdrReader &reader, KeyHasher *key);");
    out.Line("static void Size(CdrSizer &sizer, " + value + ");");
    out.Line("static void Print(TextWriter &text, " + value + ");");
    out.Close(";");
    out.Line();
}

// `linux` and `unix` are lower-case macros that GNU compilers still have.
std::set<std::string> MacrosUsedAsNames(const Model &model)
{
    std::set<std::string> used;
    const auto note = [&](const std::string &name)
    {
        if (name == "linux" || name == "unix")
        {
            used.insert(name);
        }
    };
    for (const auto &definition : model.Definitions)
    {
        note(definition->Name);
        for (const std::string &module : definition->Scope)
        {
            note(module);
        }
        if (const auto *structure = dynamic_cast<const StructDefinition *>(definition.get()))
        {
            for (const Member &member : structure->Members)
            {
                note(member.Name);
            }
        }
        else if (const auto *choice = dynamic_cast<const UnionDefinition *>(definition.get()))
        {
            for (const Case &item : choice->Cases)
            {
                note(item.Content.Name);
            }
        }
        else if (const auto *enumeration = dynamic_cast<const EnumDefinition *>(definition.get()))
        {
            for (const auto &enumerator : enumeration->Enumerators)
            {
                note(enumerator.Name);
            }
        }
        else if (const auto *bitmask = dynamic_cast<const BitmaskDefinition *>(definition.get()))
        {
            for (const auto &bit : bitmask->Bits)
            {
                note(bit.Name);
            }
        }
    }
    return used;
}

}  // namespace

std::string EmitHeader(const Model &model)
{
    TextBuilder out;
    out.Line("// Generated from " + model.MainFile + " by Rabit's IDL generator. Do not edit.");
    out.Line("#pragma once");
    out.Line();
    for (const std::string &macro : MacrosUsedAsNames(model))
    {
        out.Line("#undef " + macro + "  // a macro of GNU C++ if it is not asked for standard C++ alone");
    }
    out.Line("#include <rabit/RabitMessage.h>");
    out.Line("#include <rabit/idl/Box.h>");
    out.Line("#include <rabit/idl/Codec.h>");
    out.Line("#include <rabit/idl/Fresh.h>");
    out.Line();
    for (const std::string &include : model.Includes)
    {
        out.Line("#include \"" + include + ".h\"");
    }
    for (const char *header :
         {"array", "cstddef", "cstdint", "limits", "memory", "string", "string_view", "variant", "vector"})
    {
        out.Line(std::string("#include <") + header + ">");
    }
    out.Line();
    {
        const std::set<std::string> names = NamesOf(model);
        Namespaces namespaces(out);
        for (const auto &definition : model.Definitions)
        {
            if (definition->InMainFile)
            {
                namespaces.Enter(definition->Scope);
                EmitDefinition(out, *definition, names);
            }
        }
    }
    for (const auto &definition : model.Definitions)
    {
        if (definition->InMainFile)
        {
            EmitCodecDeclaration(out, *definition);
        }
    }
    return out.Text();
}

}  // namespace RabitIdl
