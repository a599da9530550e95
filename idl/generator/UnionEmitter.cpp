#include "UnionEmitter.h"

#include "CppText.h"
#include "model/Names.h"

#include <algorithm>

namespace RabitIdl
{
namespace
{

// A discriminator value that selects the case.
std::int64_t LabelOf(const UnionDefinition &definition, const Case &item)
{
    return item.Labels.empty() ? definition.UnusedValue : item.Labels.front();
}

bool HasSeveralLabels(const Case &item)
{
    return item.Default || item.Labels.size() > 1;
}

// How the union keeps a member of that type.
std::string KeptType(const Type &type)
{
    const std::string maker = MakerOf(type);
    return "::Rabit::Idl::Kept<" + CppType(type) + (maker.empty() ? ">" : ", " + maker + ">");
}

// A new union selects its first member, with the value from the maker of its type.
std::string FirstContent(const UnionDefinition &definition)
{
    const Type &type = definition.Cases.front().Content.Type;
    const std::string maker = MakerOf(type);
    return maker.empty() ? ""
                         : "{::std::in_place_index<0>, ::Rabit::Idl::FreshKept<" + CppType(type) + ", " +
                               maker + ">()}";
}

std::string ContentType(const UnionDefinition &definition)
{
    std::string text = "::std::variant<";
    for (std::size_t i = 0; i < definition.Cases.size(); ++i)
    {
        text += (i == 0 ? "" : ", ") + KeptType(definition.Cases[i].Content.Type);
    }
    return text + (definition.HasUnusedValue ? ", ::std::monostate>" : ">");
}

// Parameter types of the setters: a large value has two, to copy and to move.
std::vector<std::string> Parameters(const Type &type)
{
    const std::string name = CppType(type);
    return IsSmall(type) ? std::vector<std::string>{name + " "}
                         : std::vector<std::string>{"const " + name + " &", name + " &&"};
}

std::string Passed(const std::string &parameter)
{
    return parameter.back() == '&' && parameter[parameter.size() - 2] == '&' ? "::std::move(value)" : "value";
}

void EmitLines(TextBuilder &out, const std::string &lines)
{
    for (std::size_t at = 0, end = 0; at < lines.size(); at = end + 1)
    {
        end = std::min(lines.find('\n', at), lines.size());
        out.Line(lines.substr(at, end - at));
    }
}

std::string SelectedBy(const UnionDefinition &definition, const Case &item)
{
    std::string text;
    for (const std::int64_t label : item.Labels)
    {
        text += (text.empty() ? "" : ", ") + CppLabel(label, definition.Discriminator);
    }
    if (item.Default)
    {
        text += text.empty() ? "every other value" : " and every other value";
    }
    return text;
}

}  // namespace

void EmitUnionClass(TextBuilder &out, const UnionDefinition &definition)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    const std::string selector = CppType(definition.Discriminator);
    out.Line("// Holds the one member that the discriminator selects. A new one selects `" +
             definition.Cases.front().Content.Name + "`.");
    out.Line("// Reading a member that is not selected throws std::logic_error.");
    out.Line("class " + definition.Name);
    out.Open();
    out.Label("public:");
    out.Line("// The discriminator.");
    out.Line(selector + " _d() const { return _discriminator; }");
    out.Line("// Gives it another value that selects the same member, else throws std::logic_error.");
    out.Line("void _d(" + selector + " value);");
    if (definition.HasUnusedValue)
    {
        out.Line("// Selects no member.");
        out.Line("void _default();");
    }
    for (const Case &item : definition.Cases)
    {
        const std::string type = CppType(item.Content.Type);
        const std::string &member = item.Content.Name;
        out.Comment(item.Content.Comment);
        out.Line("// Selected by " + SelectedBy(definition, item) + ". Setting it selects it.");
        out.Line("const " + type + " &" + member + "() const;");
        out.Line(type + " &" + member + "();");
        for (const std::string &parameter : Parameters(item.Content.Type))
        {
            out.Line("void " + member + "(" + parameter + "value);");
            if (HasSeveralLabels(item))
            {
                out.Line("void " + member + "(" + parameter + "value, " + selector + " discriminator);");
            }
        }
    }
    out.Line();
    out.Label("private:");
    out.Line("friend struct ::Rabit::Idl::Codec<" + name + ">;");
    out.Line("friend bool operator==(const " + name + " &a, const " + name + " &b);");
    out.Line("// The place of the selected member in the variant; -1 if the value is not allowed.");
    out.Line("static int _caseOf(" + selector + " discriminator);");
    out.Line("[[noreturn]] static void _wrongMember();");
    out.Line();
    out.Line(selector + " _discriminator = " +
             CppLabel(LabelOf(definition, definition.Cases.front()), definition.Discriminator) + ";");
    out.Line(ContentType(definition) + " _content" + FirstContent(definition) + ";");
    out.Close(";");
    out.Line("// For people.");
    out.Line("::std::string ToString(const " + name + " &value);");
}

void EmitUnionFunctions(TextBuilder &out, const UnionDefinition &definition)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    const std::string selector = CppType(definition.Discriminator);
    const std::string method = name.substr(2) + "::";

    out.Line("int " + method + "_caseOf(" + selector + " discriminator)");
    out.Open();
    const Type &real = Unalias(definition.Discriminator);
    const bool isBool = real.What == Type::Kind::Primitive && real.Scalar == Primitive::Bool;
    out.Line(isBool ? "switch (static_cast<int>(discriminator))" : "switch (discriminator)");
    out.Open();
    for (std::size_t i = 0; i < definition.Cases.size(); ++i)
    {
        for (const std::int64_t label : definition.Cases[i].Labels)
        {
            out.Label("case " + CppLabel(label, definition.Discriminator) + ":");
        }
        if (!definition.Cases[i].Labels.empty())
        {
            out.Line("return " + std::to_string(i) + ";");
        }
    }
    out.Label("default:");
    out.Line("break;");
    out.Close();
    std::string other = definition.HasUnusedValue ? std::to_string(definition.Cases.size()) : "-1";
    for (std::size_t i = 0; i < definition.Cases.size(); ++i)
    {
        other = definition.Cases[i].Default ? std::to_string(i) : other;
    }
    out.Line("return " + other + ";");
    out.Close();
    out.Line();

    out.Line("void " + method + "_wrongMember()");
    out.Open();
    out.Line("throw ::std::logic_error(\"" + ScopedName(definition.Scope, definition.Name) +
             ": the discriminator selects another member\");");
    out.Close();
    out.Line();

    out.Line("void " + method + "_d(" + selector + " value)");
    out.Open();
    out.Line("if (_caseOf(value) != static_cast<int>(_content.index()))");
    out.Open();
    out.Line("_wrongMember();");
    out.Close();
    out.Line("_discriminator = value;");
    out.Close();
    out.Line();

    if (definition.HasUnusedValue)
    {
        out.Line("void " + method + "_default()");
        out.Open();
        out.Line("_discriminator = " + CppLabel(definition.UnusedValue, definition.Discriminator) + ";");
        out.Line("_content.emplace<" + std::to_string(definition.Cases.size()) + ">();");
        out.Close();
        out.Line();
    }
    for (std::size_t i = 0; i < definition.Cases.size(); ++i)
    {
        const Case &item = definition.Cases[i];
        const std::string type = CppType(item.Content.Type);
        const std::string index = std::to_string(i);
        for (const std::string constness : {"const ", ""})
        {
            out.Line(constness + type + " &" + method + item.Content.Name + "()" +
                     (constness.empty() ? "" : " const"));
            out.Open();
            out.Line("if (_content.index() != " + index + ")");
            out.Open();
            out.Line("_wrongMember();");
            out.Close();
            out.Line("return ::Rabit::Idl::Held(*::std::get_if<" + index + ">(&_content));");
            out.Close();
            out.Line();
        }
        for (const std::string &parameter : Parameters(item.Content.Type))
        {
            const std::string head = "void " + method + item.Content.Name + "(" + parameter + "value";
            const std::string emplace = "_content.emplace<" + index + ">(" + Passed(parameter) + ");";
            out.Line(head + ")");
            out.Open();
            out.Line(emplace);
            out.Line("_discriminator = " + CppLabel(LabelOf(definition, item), definition.Discriminator) +
                     ";");
            out.Close();
            out.Line();
            if (!HasSeveralLabels(item))
            {
                continue;
            }
            out.Line(head + ", " + selector + " discriminator)");
            out.Open();
            out.Line("if (_caseOf(discriminator) != " + index + ")");
            out.Open();
            out.Line("_wrongMember();");
            out.Close();
            out.Line(emplace);
            out.Line("_discriminator = discriminator;");
            out.Close();
            out.Line();
        }
    }
    out.Line("bool " + ScopedName(definition.Scope, "operator==") + "(const " + name + " &a, const " + name +
             " &b)");
    out.Open();
    out.Line("return a._discriminator == b._discriminator && a._content == b._content;");
    out.Close();
    out.Line();
    out.Line("::std::string " + ScopedName(definition.Scope, "ToString") + "(const " + name + " &value)");
    out.Open();
    out.Line("return ::Rabit::Idl::TextOf(\"\", value);");
    out.Close();
    out.Line();
}

void EmitUnionCodec(TextBuilder &out, const UnionDefinition &definition)
{
    const std::string name = CppScopedName(definition.Scope, definition.Name);
    const std::string codec = "Rabit::Idl::Codec<" + name + ">::";
    const std::string selector = CppType(definition.Discriminator);
    const std::string selectorCodec = CodecOf(definition.Discriminator);

    // Emits a function that handles the discriminator and then the selected member.
    const auto function = [&](const std::string &head, const std::string &first, const auto &each,
                              const std::string &none, const std::string &switchOn)
    {
        out.Line(head);
        out.Open();
        EmitLines(out, first);
        out.Line("switch (" + switchOn + ")");
        out.Open();
        for (std::size_t i = 0; i < definition.Cases.size(); ++i)
        {
            out.Label("case " + std::to_string(i) + ":");
            each(definition.Cases[i], std::to_string(i));
        }
        out.Label("default:");
        EmitLines(out, none);
        out.Close();
        out.Close();
        out.Line();
    };
    const std::string unused = definition.HasUnusedValue ? "true" : "false";
    const std::string unusedCase = std::to_string(definition.Cases.size());

    function(
        "bool " + codec + "Write(CdrWriter &writer, const " + name + " &value)",
        "if (!" + selectorCodec + "::Write(writer, value._discriminator))\n{\n    return false;\n}",
        [&](const Case &item, const std::string &i)
        {
            out.Line("return " + CodecOf(item.Content.Type) +
                     "::Write(writer, ::Rabit::Idl::Held(*::std::get_if<" + i + ">(&value._content)));");
        },
        "return " + unused + ";", "value._content.index()");
    function(
        "bool " + codec + "Read(CdrReader &reader, " + name + " &value)",
        selector + " discriminator{};\nif (!" + selectorCodec +
            "::Read(reader, discriminator))\n{\n    return false;\n}\nconst int selected = " + name +
            "::_caseOf(discriminator);",
        [&](const Case &item, const std::string &i)
        {
            out.Line("if (!Select<" + CodecOf(item.Content.Type) + ", " + i + ">(reader, value._content))");
            out.Open();
            out.Line("return false;");
            out.Close();
            out.Line("value._discriminator = discriminator;");
            out.Line("return " + CodecOf(item.Content.Type) +
                     "::Read(reader, ::Rabit::Idl::Held(*::std::get_if<" + i + ">(&value._content)));");
        },
        definition.HasUnusedValue ? "value._content.emplace<" + unusedCase +
                                        ">();\nvalue._discriminator = discriminator;\nreturn true;"
                                  : "return false;",
        "selected");
    function(
        "bool " + codec + "Scan(CdrReader &reader, KeyHasher *key)",
        selector + " discriminator{};\nif (!" + selectorCodec +
            "::Read(reader, discriminator))\n{\n    return false;\n}",
        [&](const Case &item, const std::string &)
        { out.Line("return " + CodecOf(item.Content.Type) + "::Scan(reader, key);"); },
        "return " + unused + ";", name + "::_caseOf(discriminator)");
    function(
        "void " + codec + "Size(CdrSizer &sizer, const " + name + " &value)",
        selectorCodec + "::Size(sizer, value._discriminator);",
        [&](const Case &item, const std::string &i)
        {
            out.Line(CodecOf(item.Content.Type) + "::Size(sizer, ::Rabit::Idl::Held(*::std::get_if<" + i +
                     ">(&value._content)));");
            out.Line("break;");
        },
        "break;", "value._content.index()");
    function(
        "void " + codec + "Print(TextWriter &text, const " + name + " &value)", "",
        [&](const Case &item, const std::string &i)
        {
            out.Line("text.Raw(\"{" + item.Content.Name + ": \");");
            out.Line(CodecOf(item.Content.Type) + "::Print(text, ::Rabit::Idl::Held(*::std::get_if<" + i +
                     ">(&value._content)));");
            out.Line("text.Raw(\"}\");");
            out.Line("break;");
        },
        "text.Raw(\"{}\");\nbreak;", "value._content.index()");
}

}  // namespace RabitIdl
