#include "model/Names.h"

#include <algorithm>
#include <cctype>
#include <set>

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

// Macros of standard headers that the generated code or Rabit's headers bring in.
const std::set<std::string> &Macros()
{
    static const std::set<std::string> words{
        "assert",       "errno",      "NULL",           "EOF",          "BUFSIZ",
        "FILENAME_MAX", "stdin",      "stdout",         "stderr",       "offsetof",
        "NAN",          "INFINITY",   "HUGE_VAL",       "EXIT_SUCCESS", "EXIT_FAILURE",
        "RAND_MAX",     "CHAR_BIT",   "CHAR_MAX",       "CHAR_MIN",     "SCHAR_MAX",
        "SCHAR_MIN",    "UCHAR_MAX",  "SHRT_MAX",       "SHRT_MIN",     "USHRT_MAX",
        "INT_MAX",      "INT_MIN",    "UINT_MAX",       "LONG_MAX",     "LONG_MIN",
        "ULONG_MAX",    "LLONG_MAX",  "LLONG_MIN",      "ULLONG_MAX",   "SIZE_MAX",
        "INT8_MAX",     "INT8_MIN",   "UINT8_MAX",      "INT16_MAX",    "INT16_MIN",
        "UINT16_MAX",   "INT32_MAX",  "INT32_MIN",      "UINT32_MAX",   "INT64_MAX",
        "INT64_MIN",    "UINT64_MAX", "M_PI",           "M_E",          "SEEK_SET",
        "SEEK_CUR",     "SEEK_END",   "CLOCKS_PER_SEC", "SIGINT",       "SIGTERM",
        "EINVAL",       "ENOMEM",     "EAGAIN",         "EIO",          "ERANGE",
        "EDOM",         "major",      "minor",          "makedev",      "isnan",
        "isinf",        "FLT_MAX",    "FLT_MIN",        "DBL_MAX",      "DBL_MIN",
        "TIMER_ABSTIME"};
    return words;
}

}  // namespace

std::string WhyNotCpp(const std::string &name)
{
    if (CppKeywords().count(name) != 0)
    {
        return "is a keyword of C++";
    }
    if (Macros().count(name) != 0)
    {
        return "is a macro of the C++ standard headers";
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
