#include "ros/MsgToIdl.h"

#include "model/Names.h"

#include <set>

namespace RabitIdl
{
namespace
{

std::string IdlName(const std::string &name)
{
    return (IsIdlKeyword(name) ? "_" : "") + name;
}

std::string ElementOf(const MsgType &type)
{
    switch (type.What)
    {
        case MsgType::Kind::Message:
            return IdlName(type.Package) + "::msg::" + IdlName(type.Name);
        case MsgType::Kind::String:
            return type.Bound == 0 ? "string" : "string<" + std::to_string(type.Bound) + ">";
        default:
            return type.Idl;
    }
}

std::string Declared(const MsgEntry &field)
{
    const MsgType &type = field.Type;
    const std::string element = ElementOf(type);
    const std::string name = IdlName(field.Name);
    // Two `>` in a row would be a shift to idlc.
    const std::string end = element.back() == '>' ? " >" : ">";
    switch (type.Several)
    {
        case MsgType::Array::None:
            return element + " " + name;
        case MsgType::Array::Fixed:
            return element + " " + name + "[" + std::to_string(type.Length) + "]";
        case MsgType::Array::Bounded:
            return "sequence<" + element + ", " + std::to_string(type.Length) + "> " + name;
        case MsgType::Array::Unbounded:
            return "sequence<" + element + end + " " + name;
    }
    return "";
}

// A backslash at the end would continue the comment into the next line.
void AddComment(std::string &text, const std::vector<std::string> &comment, const char *indent)
{
    for (std::string line : comment)
    {
        line.erase(line.find_last_not_of("\\ ") + 1);
        for (char &letter : line)
        {
            letter = static_cast<unsigned char>(letter) < 0x20 ? ' ' : letter;
        }
        text += indent + (line.empty() ? std::string("//") : "// " + line) + "\n";
    }
}

}  // namespace

std::string MsgToIdl(const MsgFile &file)
{
    std::set<std::string> includes;
    for (const MsgEntry &field : file.Fields)
    {
        if (field.Type.What == MsgType::Kind::Message)
        {
            includes.insert(field.Type.Package + "/msg/" + field.Type.Name + ".idl");
        }
    }
    std::string text = "// Made from " + file.Package + "/msg/" + file.Name + ".msg. Do not edit.\n";
    for (const std::string &include : includes)
    {
        text += "#include \"" + include + "\"\n";
    }
    text += "module " + IdlName(file.Package) + " {\nmodule msg {\n";
    if (!file.Constants.empty())
    {
        text += "module " + file.Name + "_Constants {\n";
        for (const MsgEntry &constant : file.Constants)
        {
            AddComment(text, constant.Comment, "    ");
            text += "    const " + ElementOf(constant.Type) + " " + IdlName(constant.Name) + " = " +
                    constant.Value + ";\n";
        }
        text += "};\n";
    }
    text += "\n";
    AddComment(text, file.Comment, "");
    text += "@final\nstruct " + IdlName(file.Name) + " {\n";
    for (const MsgEntry &field : file.Fields)
    {
        AddComment(text, field.Comment, "    ");
        text += "    " + (field.Value.empty() ? "" : "@default (value=" + field.Value + ") ") +
                Declared(field) + ";\n";
    }
    text += file.Fields.empty() ? "    uint8 structure_needs_at_least_one_member;\n" : "";
    return text + "};\n};\n};\n";
}

}  // namespace RabitIdl
