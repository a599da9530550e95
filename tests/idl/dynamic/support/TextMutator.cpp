#include "TextMutator.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

namespace
{

const char *const Words[] = {"struct",
                             "union",
                             "enum",
                             "bitmask",
                             "typedef",
                             "module",
                             "switch",
                             "case",
                             "default",
                             "sequence",
                             "string",
                             "boolean",
                             "char",
                             "octet",
                             "int8",
                             "uint8",
                             "short",
                             "unsigned",
                             "long",
                             "float",
                             "double",
                             "int16",
                             "uint32",
                             "int64",
                             "wchar",
                             "wstring",
                             "fixed",
                             "any",
                             "map",
                             "const",
                             "interface",
                             "native",
                             "bitset",
                             "valuetype",
                             "Object",
                             "void",
                             "TRUE",
                             "FALSE",
                             "{",
                             "}",
                             "<",
                             ">",
                             "(",
                             ")",
                             "[",
                             "]",
                             ";",
                             ",",
                             ":",
                             "::",
                             "-",
                             "@",
                             "@key",
                             "@nested",
                             "@final",
                             "@appendable",
                             "@mutable",
                             "@optional",
                             "@external",
                             "@default(1)",
                             "@default(\"x\")",
                             "@default",
                             "@default_literal",
                             "@value(1)",
                             "@value(4294967295)",
                             "@value",
                             "@position(63)",
                             "@position(64)",
                             "@position(1)",
                             "@bit_bound(1)",
                             "@bit_bound(64)",
                             "@bit_bound(0)",
                             "@bit_bound(65)",
                             "@bit_bound(8)",
                             "@id(1)",
                             "@id(4294967295)",
                             "@unit(\"m\")",
                             "@unit",
                             "0",
                             "1",
                             "255",
                             "256",
                             "65536",
                             "4294967295",
                             "4294967296",
                             "18446744073709551615",
                             "18446744073709551616",
                             "-1",
                             "-9223372036854775808",
                             "1.5",
                             "1e400",
                             "'x'",
                             "'\\''",
                             "\"\"",
                             "\"a\" \"b\"",
                             "sequence<octet>",
                             "string<1>",
                             "string<0>",
                             "[0]",
                             "[4294967295]",
                             "Pose",
                             "::Uav::Pose",
                             "Uav",
                             "_struct",
                             "",
                             "struct X { X x; };",
                             "struct X;",
                             "union U switch (long) { };",
                             "enum E { };",
                             "struct Y : ::Uav::Pose { };",
                             "module Uav { };",
                             "typedef octet A[2][2];",
                             "//",
                             "/*",
                             "*/",
                             "\n",
                             "#",
                             "\\",
                             "\"",
                             "'"};

// Returns pairs of the begin and end of words and signs.
std::vector<std::pair<std::size_t, std::size_t>> WordsOf(const std::string &text)
{
    const auto isName = [](char letter)
    { return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '@'; };
    std::vector<std::pair<std::size_t, std::size_t>> words;
    for (std::size_t at = 0; at < text.size();)
    {
        std::size_t end = at + 1;
        while (isName(text[at]) && end < text.size() && isName(text[end]))
        {
            ++end;
        }
        if (std::isspace(static_cast<unsigned char>(text[at])) == 0)
        {
            words.emplace_back(at, end);
        }
        at = end;
    }
    return words;
}

}  // namespace

TextMutator::TextMutator(std::vector<std::string> texts, unsigned seed)
    : _texts(std::move(texts)), _random(seed)
{
}

std::string TextMutator::Next()
{
    std::string text = AnyText();
    if (Below(3) != 0)
    {
        for (std::size_t changes = 1 + Below(3); changes > 0; --changes)
        {
            Below(3) == 0 ? ChangeStatement(text) : ChangeAlike(text);
        }
        return text;
    }
    if (Below(4) == 0)
    {
        text += AnyText();
    }
    for (std::size_t changes = 1 + Below(4); changes > 0 && !text.empty(); --changes)
    {
        switch (Below(8))
        {
            case 0:
                ChangeByte(text);
                break;
            case 1:
            case 2:
                ChangeLine(text);
                break;
            case 3:
                ChangeNumber(text);
                break;
            default:
                ChangeWord(text);
        }
    }
    return text;
}

// Replaces a word by one of its kind. The grammar still holds, so only the meaning of names and values may
// be wrong.
void TextMutator::ChangeAlike(std::string &text)
{
    static const std::vector<std::string> types{"boolean",   "char",  "octet", "int8",   "uint8",
                                                "short",     "long",  "float", "double", "string",
                                                "string<3>", "int64", "uint32"};
    static const std::vector<std::string> numbers{
        "1",   "2",   "3",     "7",     "8",       "9",          "63",         "64",
        "255", "256", "65535", "65536", "1000000", "2147483648", "4294967295", "18446744073709551615"};
    static const std::vector<std::string> languageWords{"module",   "struct", "union", "enum",    "bitmask",
                                                        "typedef",  "switch", "case",  "default", "sequence",
                                                        "unsigned", "TRUE",   "FALSE"};
    const auto isOneOf = [](const std::string &word, const std::vector<std::string> &all)
    { return std::find(all.begin(), all.end(), word) != all.end(); };
    const auto kindOf = [&](const std::string &word)
    {
        const auto first = static_cast<unsigned char>(word[0]);
        return isOneOf(word, types)           ? 1
               : std::isdigit(first) != 0     ? 2
               : isOneOf(word, languageWords) ? 0
               : std::isalpha(first) != 0     ? 3
                                              : 0;
    };
    const auto words = WordsOf(text);
    for (int tries = 0; tries < 20; ++tries)
    {
        const auto [begin, end] = words[Below(words.size())];
        const int kind = kindOf(text.substr(begin, end - begin));
        const auto [from, to] = words[Below(words.size())];
        const std::string name = text.substr(from, to - from);
        if (kind == 0 || (kind == 3 && kindOf(name) != 3))
        {
            continue;
        }
        text.replace(begin, end - begin,
                     kind == 1   ? types[Below(types.size())]
                     : kind == 2 ? numbers[Below(numbers.size())]
                                 : name);
        return;
    }
}

// Doubles, removes or moves a line with one member or one value.
void TextMutator::ChangeStatement(std::string &text)
{
    std::vector<std::pair<std::size_t, std::size_t>> statements;
    for (std::size_t begin = 0; begin < text.size();)
    {
        const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
        if (text.compare(begin, 4, "    ") == 0)
        {
            statements.emplace_back(begin, end - begin);
        }
        begin = end;
    }
    if (statements.empty())
    {
        return;
    }
    const auto [begin, size] = statements[Below(statements.size())];
    const std::string statement = text.substr(begin, size);
    const auto [place, length] = statements[Below(statements.size())];
    switch (Below(3))
    {
        case 0:
            text.insert(place, statement);
            break;
        case 1:
            text.replace(place, length, statement);
            break;
        default:
            text.erase(begin, size);
    }
}

void TextMutator::ChangeByte(std::string &text)
{
    const std::size_t at = Below(text.size());
    switch (Below(3))
    {
        case 0:
            text[at] = static_cast<char>(Below(256));
            break;
        case 1:
            text.erase(at, 1 + Below(20));
            break;
        default:
            text.insert(at, 1 + Below(3), static_cast<char>(32 + Below(95)));
    }
}

void TextMutator::ChangeWord(std::string &text)
{
    const auto words = WordsOf(text);
    if (words.empty())
    {
        return;
    }
    const auto [begin, end] = words[Below(words.size())];
    const std::string other = Below(2) == 0 ? Words[Below(std::size(Words))]
                                            : [&]
    {
        const auto [from, to] = words[Below(words.size())];
        return text.substr(from, to - from);
    }();
    switch (Below(3))
    {
        case 0:
            text.replace(begin, end - begin, other);
            break;
        case 1:
            text.insert(begin, other + " ");
            break;
        default:
            text.erase(begin, end - begin);
    }
}

void TextMutator::ChangeLine(std::string &text)
{
    const auto lineAt = [](const std::string &whole, std::size_t at)
    {
        const std::size_t begin = at == 0 ? 0 : whole.rfind('\n', at - 1) + 1;
        const std::size_t end = std::min(whole.find('\n', at), whole.size());
        return std::pair(begin, end >= begin ? end - begin : 0);
    };
    const std::string &from = Below(2) == 0 ? text : AnyText();
    const auto [begin, size] = lineAt(from, Below(from.size()));
    const std::string line = from.substr(begin, size) + "\n";
    const auto [place, length] = lineAt(text, Below(text.size()));
    if (Below(2) == 0)
    {
        text.insert(place, line);
    }
    else
    {
        text.replace(place, length, Below(2) == 0 ? line : "");
    }
}

void TextMutator::ChangeNumber(std::string &text)
{
    static const char *const numbers[] = {"0",
                                          "1",
                                          "2",
                                          "7",
                                          "63",
                                          "64",
                                          "255",
                                          "65535",
                                          "65536",
                                          "2147483647",
                                          "4294967295",
                                          "4294967296",
                                          "18446744073709551615",
                                          "99999999999999999999",
                                          "-1",
                                          "-0",
                                          "1.0",
                                          "00",
                                          "08"};
    std::vector<std::size_t> places;
    for (std::size_t at = 0; at < text.size(); ++at)
    {
        if (std::isdigit(static_cast<unsigned char>(text[at])) != 0)
        {
            places.push_back(at);
        }
    }
    if (!places.empty())
    {
        text.replace(places[Below(places.size())], 1, numbers[Below(std::size(numbers))]);
    }
}
