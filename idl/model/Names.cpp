#include "model/Names.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "model/LibraryNames.h"

namespace RabitIdl
{
namespace
{

// C++20, [lex.key], with the alternative tokens.
const std::set<std::string> &CppKeywords()
{
    static const std::set<std::string> words{
        "alignas",     "alignof",  "and",        "and_eq",    "asm",       "auto",         "bitand",
        "bitor",       "bool",     "break",      "case",      "catch",     "char",         "char16_t",
        "char32_t",    "char8_t",  "class",      "co_await",  "co_return", "co_yield",     "compl",
        "concept",     "const",    "const_cast", "consteval", "constexpr", "constinit",    "continue",
        "decltype",    "default",  "delete",     "do",        "double",    "dynamic_cast", "else",
        "enum",        "explicit", "export",     "extern",    "false",     "float",        "for",
        "friend",      "goto",     "if",         "inline",    "int",       "long",         "mutable",
        "namespace",   "new",      "noexcept",   "not",       "not_eq",    "nullptr",      "operator",
        "or",          "or_eq",    "private",    "protected", "public",    "register",     "reinterpret_cast",
        "requires",    "return",   "short",      "signed",    "sizeof",    "static",       "static_assert",
        "static_cast", "struct",   "switch",     "template",  "this",      "thread_local", "throw",
        "true",        "try",      "typedef",    "typeid",    "typename",  "union",        "unsigned",
        "using",       "virtual",  "void",       "volatile",  "wchar_t",   "while",        "xor",
        "xor_eq"};
    return words;
}

// How a name begins that is of a family of macros in generated code; empty if it is of none. The members of
// a family differ from one version of a library to the next.
std::string MacroFamily(const std::string &name)
{
    for (const char *const prefix : {"BOOST_", "CLONE_", "FASTCDR_", "PTHREAD_", "SCHED_"})
    {
        if (name.starts_with(prefix))
        {
            return prefix;
        }
    }
    // SYS_read.
    return name.starts_with("SYS_") && std::islower(static_cast<unsigned char>(name.c_str()[4])) != 0
               ? "SYS_ and a lower-case letter"
               : "";
}

}  // namespace

std::string WhyNotCpp(const std::string &name)
{
    if (CppKeywords().count(name) != 0)
    {
        return "is a keyword of C++";
    }
    if (IsLibraryMacro(name))
    {
        return "is a macro of the headers that generated code includes";
    }
    if (const std::string family = MacroFamily(name); !family.empty())
    {
        return "begins with " + family + ", as macros in generated code do";
    }
    // Private members of Rabit and of generated code begin with an underscore, too.
    return name[0] == '_' || name.find("__") != std::string::npos ? "is reserved in C++" : "";
}

bool IsMessageMember(const std::string &name)
{
    static const std::set<std::string> words{"MessageType",
                                             "MessageSource",
                                             "MessageDestination",
                                             "RabitMessage",
                                             "Clone",
                                             "CopyMessage",
                                             "Clear",
                                             "ToString",
                                             "Serialize",
                                             "DeSerialize",
                                             "GetGlobalPublishSubscribeMessageRef",
                                             "SetGlobalPublishSubscribeMessageRef",
                                             "CopyBase",
                                             "GetTypeIndex",
                                             "SetTimeNow",
                                             "GetTimeStamp",
                                             "SetTimeStamp",
                                             "TimeStampSeconds",
                                             "CompareTime",
                                             "Register_SomethingPublished",
                                             "PostMessage",
                                             "PostMessageWin",
                                             "GetAgeSeconds",
                                             "WasPosted",
                                             "GetPostTime",
                                             "FetchMessage",
                                             "getSerializedMsgHeaderSize",
                                             "SerializeMsgHeader",
                                             "DeSerializeMsgHeader",
                                             "IdlType"};
    return words.count(name) != 0;
}

bool IsGeneratorName(const std::string &name)
{
    return name == "ToString" || name == "FromText" || name == "Has";
}

bool IsTypedefOfRos(const std::string &name)
{
    return name[0] != '_' && name.find("__") != std::string::npos;
}

bool IsIdlKeyword(const std::string &name)
{
    // OMG IDL 4.2, 7.2.4.
    static const std::set<std::string> words{
        "abstract",  "any",       "alias",      "attribute",  "bitfield",  "bitmask",   "bitset",
        "boolean",   "case",      "char",       "component",  "connector", "const",     "consumes",
        "context",   "custom",    "default",    "double",     "exception", "emits",     "enum",
        "eventtype", "factory",   "false",      "finder",     "fixed",     "float",     "getraises",
        "home",      "import",    "in",         "inout",      "interface", "local",     "long",
        "manages",   "map",       "mirrorport", "module",     "multiple",  "native",    "object",
        "octet",     "oneway",    "out",        "primarykey", "private",   "port",      "porttype",
        "provides",  "public",    "publishes",  "raises",     "readonly",  "setraises", "sequence",
        "short",     "string",    "struct",     "supports",   "switch",    "true",      "truncatable",
        "typedef",   "typeid",    "typename",   "typeprefix", "unsigned",  "union",     "uses",
        "valuebase", "valuetype", "void",       "wchar",      "wstring",   "int8",      "uint8",
        "int16",     "int32",     "int64",      "uint16",     "uint32",    "uint64"};
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return words.count(lower) != 0;
}

std::string ScopedName(const std::vector<std::string> &scope, const std::string &name)
{
    std::string text;
    for (const std::string &part : scope)
    {
        text += part + "::";
    }
    return text + name;
}

std::string CppScopedName(const std::vector<std::string> &scope, const std::string &name)
{
    return "::" + ScopedName(scope, name);
}

}  // namespace RabitIdl
