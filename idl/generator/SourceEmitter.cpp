#include "SourceEmitter.h"

#include <algorithm>
#include <cctype>

#include "CppText.h"
#include "UnionEmitter.h"
#include "model/IdlTextEmitter.h"
#include "model/Names.h"
#include "model/RosTypeHash.h"
#include "model/TextBuilder.h"

namespace RabitIdl
{
namespace
{

void EmitToString(TextBuilder &out, const Definition &definition, const std::string &parameter)
{
    out.Line("::std::string " + ScopedName(definition.Scope, "ToString") + "(" + parameter + "value)");
    out.Open();
    out.Line("return ::Rabit::Idl::TextOf(\"\", value);");
    out.Close();
    out.Line();
}

void EmitEquality(TextBuilder &out, const StructDefinition &definition)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    out.Line("bool " + ScopedName(definition.Scope, "operator==") + "(const " + name + " &a, const " + name +
             " &b)");
    out.Open();
    const auto members = AllMembers(definition);
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        const std::string &member = members[i]->Name;
        out.Line((i == 0 ? "return a." : "       a.") + member + " == b." + member +
                 (i + 1 == members.size() ? ";" : " &&"));
    }
    out.Close();
    out.Line();
}

std::string ClearLine(const Member &member)
{
    const Type &type = Unalias(member.Type);
    const std::string name = "this->" + member.Name;
    const bool keepsMemory = type.What == Type::Kind::Sequence || type.What == Type::Kind::String;
    if (keepsMemory && !member.Default)
    {
        return name + ".clear();";
    }
    if (type.What == Type::Kind::Array && MakerOf(type).empty())
    {
        return name + ".fill({});";
    }
    const std::string initializer = Initializer(member);
    return name + (initializer == "{}" ? " = {}" : initializer) + ";";
}

void EmitMessageFunctions(TextBuilder &out, const Model &model, const StructDefinition &definition)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    const std::string method = name.substr(2) + "::";
    const auto members = AllMembers(definition);

    out.Line("const ::Rabit::MessageType &" + method + "IdlType()");
    out.Open();
    out.Line("// Never destroyed: threads may still use it when static objects are.");
    const std::string hash = RosTypeHash(definition);
    out.Line("static const auto &type = *new ::Rabit::Idl::GeneratedMessageType<" + name + ">(\"" +
             ScopedName(definition.Scope, definition.Name) + "\", R\"idl(" + EmitIdlText(model, definition) +
             ")idl\"" + (hash.empty() ? "" : ", \"" + hash + "\"") + ");");
    out.Line("return type;");
    out.Close();
    out.Line();
    out.Line("::std::unique_ptr<::Rabit::RabitMessage> " + method + "Clone() const");
    out.Open();
    out.Line("return ::std::make_unique<" + name + ">(*this);");
    out.Close();
    out.Line();
    out.Line("bool " + method + "CopyMessage(::Rabit::RabitMessage *msg)");
    out.Open();
    out.Line("if (msg == nullptr || typeid(*msg) != typeid(" + name + "))");
    out.Open();
    out.Line("return false;");
    out.Close();
    out.Line("const auto &other = static_cast<const " + name + " &>(*msg);");
    out.Line("::Rabit::RabitMessage::CopyMessage(msg);");
    for (const Member *member : members)
    {
        out.Line("this->" + member->Name + " = other." + member->Name + ";");
    }
    out.Line("return true;");
    out.Close();
    out.Line();
    out.Line("void " + method + "Clear()");
    out.Open();
    out.Line("::Rabit::RabitMessage::Clear();");
    for (const Member *member : members)
    {
        out.Line(ClearLine(*member));
    }
    out.Close();
    out.Line();
    out.Line("::std::string " + method + "ToString() const");
    out.Open();
    out.Line("return ::Rabit::Idl::TextOf(\"" + ScopedName(definition.Scope, definition.Name) +
             " \", *this);");
    out.Close();
    out.Line();
    out.Line("int " + method + "Serialize(::std::uint8_t *buf, int maxBufSize, int stype)");
    out.Open();
    out.Line("return ::Rabit::Idl::SerializeTo(IdlType(), *this, buf, maxBufSize, stype);");
    out.Close();
    out.Line();
    out.Line("int " + method + "DeSerialize(::std::uint8_t *buf, int len, int stype)");
    out.Open();
    out.Line("return ::Rabit::Idl::DeserializeFrom(IdlType(), *this, buf, len, stype);");
    out.Close();
    out.Line();
}

// Writes `return A && B && C;` over the members of a struct.
template <class Each>
void EmitConjunction(TextBuilder &out, const std::vector<const Member *> &members, const Each &each)
{
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        out.Line((i == 0 ? "return " : "       ") + each(*members[i]) +
                 (i + 1 == members.size() ? ";" : " &&"));
    }
}

void EmitStructCodec(TextBuilder &out, const StructDefinition &definition)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    const std::string codec = "Rabit::Idl::Codec<" + name + ">::";
    const auto members = AllMembers(definition);
    const bool someKeys = HasKey(definition);

    out.Line("bool " + codec + "Write(CdrWriter &writer, const " + name + " &value)");
    out.Open();
    EmitConjunction(out, members,
                    [](const Member &member)
                    { return CodecOf(member.Type) + "::Write(writer, value." + member.Name + ")"; });
    out.Close();
    out.Line();
    out.Line("bool " + codec + "Read(CdrReader &reader, " + name + " &value)");
    out.Open();
    EmitConjunction(out, members,
                    [](const Member &member)
                    { return CodecOf(member.Type) + "::Read(reader, value." + member.Name + ")"; });
    out.Close();
    out.Line();
    out.Line("bool " + codec + "Scan(CdrReader &reader, [[maybe_unused]] KeyHasher *key)");
    out.Open();
    EmitConjunction(out, members,
                    [&](const Member &member)
                    {
                        // If a struct without keys of its own is a key, all of its members count.
                        const bool isKey = !someKeys || member.Key;
                        return CodecOf(member.Type) + "::Scan(reader, " + (isKey ? "key" : "nullptr") + ")";
                    });
    out.Close();
    out.Line();
    out.Line("void " + codec + "Size(CdrSizer &sizer, const " + name + " &value)");
    out.Open();
    for (const Member *member : members)
    {
        out.Line(CodecOf(member->Type) + "::Size(sizer, value." + member->Name + ");");
    }
    out.Close();
    out.Line();
    out.Line("void " + codec + "Print(TextWriter &text, const " + name + " &value)");
    out.Open();
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        out.Line(std::string("text.Raw(\"") + (i == 0 ? "{" : ", ") + members[i]->Name + ": \");");
        out.Line(CodecOf(members[i]->Type) + "::Print(text, value." + members[i]->Name + ");");
    }
    out.Line("text.Raw(\"}\");");
    out.Close();
    out.Line();
}

// Writes the codec of an enum or bitmask: an unsigned number with a check for declared values.
void EmitNumberCodec(TextBuilder &out, const Definition &definition, const std::string &isKnown)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    const std::string codec = "Rabit::Idl::Codec<" + name + ">::";
    const std::string number = "::Rabit::Idl::Scalar<::std::underlying_type_t<" + name + ">>";
    out.Line("bool " + codec + "Write(CdrWriter &writer, " + name + " value)");
    out.Open();
    out.Line("return " + isKnown + "(value) && " + number +
             "::Write(writer, static_cast<::std::underlying_type_t<" + name + ">>(value));");
    out.Close();
    out.Line();
    out.Line("bool " + codec + "Read(CdrReader &reader, " + name + " &value)");
    out.Open();
    out.Line("::std::underlying_type_t<" + name + "> number = 0;");
    out.Line("if (!" + number + "::Read(reader, number) || !" + isKnown + "(static_cast<" + name +
             ">(number)))");
    out.Open();
    out.Line("return false;");
    out.Close();
    out.Line("value = static_cast<" + name + ">(number);");
    out.Line("return true;");
    out.Close();
    out.Line();
    out.Line("bool " + codec + "Scan(CdrReader &reader, KeyHasher *key)");
    out.Open();
    out.Line(name + " value{};");
    out.Line("if (!Read(reader, value))");
    out.Open();
    out.Line("return false;");
    out.Close();
    out.Line("if (key != nullptr)");
    out.Open();
    out.Line("key->Put(static_cast<::std::underlying_type_t<" + name + ">>(value));");
    out.Close();
    out.Line("return true;");
    out.Close();
    out.Line();
    out.Line("void " + codec + "Size(CdrSizer &sizer, " + name + ")");
    out.Open();
    out.Line("sizer.Add(MinSize);");
    out.Close();
    out.Line();
}

void EmitEnumSource(TextBuilder &out, const EnumDefinition &definition)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    const std::string isKnown = "IsKnown";
    out.Line("namespace Rabit::Idl");
    out.Line("{");
    out.Line("static bool " + isKnown + "(" + name + " value)");
    out.Open();
    out.Line("switch (value)");
    out.Open();
    for (const auto &enumerator : definition.Enumerators)
    {
        out.Label("case " + name + "::" + enumerator.Name + ":");
    }
    out.Line("return true;");
    out.Close();
    out.Line("return false;");
    out.Close();
    out.Line("}");
    out.Line();
    EmitNumberCodec(out, definition, isKnown);
    out.Line("void Rabit::Idl::Codec<" + name + ">::Print(TextWriter &text, " + name + " value)");
    out.Open();
    out.Line("switch (value)");
    out.Open();
    for (const auto &enumerator : definition.Enumerators)
    {
        out.Label("case " + name + "::" + enumerator.Name + ":");
        out.Line("text.Raw(\"" + enumerator.Name + "\");");
        out.Line("return;");
    }
    out.Close();
    out.Line("text.Put(static_cast<::std::uint32_t>(value));");
    out.Close();
    out.Line();
    EmitToString(out, definition, name + " ");
    out.Line("bool " + ScopedName(definition.Scope, "FromText") + "(::std::string_view text, " + name +
             " &value)");
    out.Open();
    for (const auto &enumerator : definition.Enumerators)
    {
        out.Line("if (text == \"" + enumerator.Name + "\")");
        out.Open();
        out.Line("value = " + name + "::" + enumerator.Name + ";");
        out.Line("return true;");
        out.Close();
    }
    out.Line("return false;");
    out.Close();
    out.Line();
}

void EmitBitmaskSource(TextBuilder &out, const BitmaskDefinition &definition)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    unsigned long long all = 0;
    for (const auto &bit : definition.Bits)
    {
        all |= 1ULL << bit.Position;
    }
    const std::string isKnown = "IsKnown";
    out.Line("namespace Rabit::Idl");
    out.Line("{");
    out.Line("static bool " + isKnown + "(" + name + " value)");
    out.Open();
    out.Line("return (static_cast<::std::uint64_t>(value) & ~" + std::to_string(all) + "ULL) == 0;");
    out.Close();
    out.Line("}");
    out.Line();
    EmitNumberCodec(out, definition, isKnown);
    out.Line("void Rabit::Idl::Codec<" + name + ">::Print(TextWriter &text, " + name + " value)");
    out.Open();
    out.Line("auto left = static_cast<::std::uint64_t>(value);");
    out.Line("const char *separator = \"\";");
    for (const auto &bit : definition.Bits)
    {
        const std::string number = std::to_string(1ULL << bit.Position) + "ULL";
        out.Line("if ((left & " + number + ") != 0)");
        out.Open();
        out.Line("text.Raw(separator);");
        out.Line("text.Raw(\"" + bit.Name + "\");");
        out.Line("separator = \"|\";");
        out.Line("left &= ~" + number + ";");
        out.Close();
    }
    out.Line("if (left != 0 || *separator == '\\0')");
    out.Open();
    out.Line("text.Raw(separator);");
    out.Line("text.Put(left);");
    out.Close();
    out.Close();
    out.Line();
    EmitToString(out, definition, name + " ");
    out.Line("bool " + ScopedName(definition.Scope, "FromText") + "(::std::string_view text, " + name +
             " &value)");
    out.Open();
    out.Line("if (text == \"0\")");
    out.Open();
    out.Line("value = " + name + "{};");
    out.Line("return true;");
    out.Close();
    out.Line("::std::uint64_t bits = 0;");
    out.Line("for (bool more = true; more;)");
    out.Open();
    out.Line("const ::std::size_t end = text.find('|');");
    out.Line("const ::std::string_view one = text.substr(0, end);");
    for (std::size_t i = 0; i < definition.Bits.size(); ++i)
    {
        const auto &bit = definition.Bits[i];
        out.Line((i == 0 ? "if (one == \"" : "else if (one == \"") + bit.Name + "\")");
        out.Open();
        out.Line("bits |= " + std::to_string(1ULL << bit.Position) + "ULL;");
        out.Close();
    }
    out.Line("else");
    out.Open();
    out.Line("return false;");
    out.Close();
    out.Line("more = end != ::std::string_view::npos;");
    out.Line("text.remove_prefix(more ? end + 1 : text.size());");
    out.Close();
    out.Line("value = static_cast<" + name + ">(bits);");
    out.Line("return true;");
    out.Close();
    out.Line();
}

void EmitDefinition(TextBuilder &out, const Model &model, const Definition &definition)
{
    if (const auto *structure = dynamic_cast<const StructDefinition *>(&definition))
    {
        const std::string name = CppScopedName(definition.Scope, definition.Name);
        EmitStructCodec(out, *structure);
        EmitEquality(out, *structure);
        if (IsMessage(*structure))
        {
            EmitMessageFunctions(out, model, *structure);
        }
        else
        {
            EmitToString(out, definition, "const " + name + " &");
        }
    }
    else if (const auto *choice = dynamic_cast<const UnionDefinition *>(&definition))
    {
        EmitUnionFunctions(out, *choice);
        EmitUnionCodec(out, *choice);
    }
    else if (const auto *enumeration = dynamic_cast<const EnumDefinition *>(&definition))
    {
        EmitEnumSource(out, *enumeration);
    }
    else if (const auto *bitmask = dynamic_cast<const BitmaskDefinition *>(&definition))
    {
        EmitBitmaskSource(out, *bitmask);
    }
}

void EmitRegistration(TextBuilder &out, const Model &model)
{
    // Named after the file, since several generated sources may be compiled as one.
    std::string name = "areRegistered_" + model.MainFile;
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    out.Line("namespace Rabit::Idl");
    out.Line("{");
    out.Line("// Runs before main(), so that the types can be found by name.");
    out.Line("[[maybe_unused]] static const bool " + name + " = []");
    out.Open();
    for (const auto &definition : model.Definitions)
    {
        const auto *structure = dynamic_cast<const StructDefinition *>(definition.get());
        if (structure != nullptr && structure->InMainFile && IsMessage(*structure))
        {
            out.Line("::Rabit::MessageTypeRegistry::Add(" + CppScopedName(structure->Scope, structure->Name) +
                     "::IdlType());");
        }
    }
    out.Line("return true;");
    out.Close("();");
    out.Line("}  // namespace Rabit::Idl");
}

}  // namespace

std::string EmitSource(const Model &model)
{
    TextBuilder out;
    out.Line("// Generated from " + model.MainFile + " by Rabit's IDL generator. Do not edit.");
    out.Line("#include \"" + model.MainFile + ".h\"");
    out.Line();
    out.Line("#include <rabit/idl/GeneratedMessageType.h>");
    out.Line("#include <rabit/idl/MessageTypeRegistry.h>");
    out.Line("#include <rabit/idl/Shapes.h>");
    out.Line();
    out.Line("#include <stdexcept>");
    out.Line("#include <type_traits>");
    out.Line("#include <typeinfo>");
    out.Line();
    for (const auto &definition : model.Definitions)
    {
        if (definition->InMainFile)
        {
            EmitDefinition(out, model, *definition);
        }
    }
    EmitRegistration(out, model);
    return out.Text();
}

}  // namespace RabitIdl
