#include "model/SourceScan.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>

namespace RabitIdl
{
namespace
{

struct Found
{
    std::string File;
    std::uint32_t Line = 0;
    std::string Name;
};

// Scans IDL text and skips comments, strings and characters.
class Scanner
{
public:
    Scanner(std::string file, std::string text, Refusals &refusals)
        : _file(std::move(file)), _text(std::move(text)), _refusals(refusals)
    {
    }

    void Run(std::vector<Found> &used, std::set<std::string> &declared)
    {
        while (_at < _text.size())
        {
            const char letter = _text[_at];
            if (letter == '/' && Peek(1) == '/')
            {
                SkipTo("\n");
            }
            else if (letter == '/' && Peek(1) == '*')
            {
                SkipTo("*/");
            }
            else if (letter == '"' || letter == '\'')
            {
                SkipQuoted(letter);
            }
            else if (letter == '@')
            {
                Annotation(used, declared);
            }
            else if (letter == '#')
            {
                CheckPragma();
            }
            else
            {
                Step();
            }
        }
    }

private:
    char Peek(std::size_t ahead) const { return _at + ahead < _text.size() ? _text[_at + ahead] : '\0'; }

    void Step()
    {
        if (_text[_at] == '\n')
        {
            ++_line;
        }
        ++_at;
    }

    void SkipTo(const std::string &end)
    {
        while (_at < _text.size() && _text.compare(_at, end.size(), end) != 0)
        {
            Step();
        }
        _at = std::min(_text.size(), _at + (end == "\n" ? 0 : end.size()));
    }

    // Skips a string or character, which ends at the end of the line at the latest.
    void SkipQuoted(char quote)
    {
        ++_at;
        while (_at < _text.size() && _text[_at] != quote && _text[_at] != '\n')
        {
            if (_text[_at] == '\\')
            {
                CheckEscape();
                ++_at;
            }
            ++_at;
        }
        _at = std::min(_text.size(), _at + (_at < _text.size() && _text[_at] == quote ? 1 : 0));
    }

    void CheckPragma()
    {
        Step();
        if (Name() == "pragma" && Name() == "DCPS_DATA_KEY")
        {
            _refusals.Add(_file, _line, "#pragma DCPS_DATA_KEY is not supported, mark the members with @key");
        }
    }

    void CheckEscape()
    {
        const auto isHexLetter = [](char letter)
        { return std::isxdigit(letter) != 0 && std::isdigit(letter) == 0; };
        if (Peek(1) == 'x' && (isHexLetter(Peek(2)) || (std::isdigit(Peek(2)) != 0 && isHexLetter(Peek(3)))))
        {
            _refusals.Add(
                _file, _line,
                "hexadecimal escapes with letters are not supported (idlc misreads them), write them octal");
        }
    }

    void SkipSpace()
    {
        while (_at < _text.size() && std::isspace(static_cast<unsigned char>(_text[_at])))
        {
            Step();
        }
    }

    // The last part of a scoped name.
    std::string Name()
    {
        std::string name;
        SkipSpace();
        while (_at < _text.size())
        {
            const char letter = _text[_at];
            if (letter == ':' && Peek(1) == ':')
            {
                name.clear();
                _at += 2;
            }
            else if (std::isalnum(static_cast<unsigned char>(letter)) || letter == '_')
            {
                name += letter;
                ++_at;
            }
            else
            {
                break;
            }
        }
        return name;
    }

    void Annotation(std::vector<Found> &used, std::set<std::string> &declared)
    {
        Step();
        const std::uint32_t line = _line;
        const std::string name = Name();
        if (name == "annotation")
        {
            declared.insert(Name());
        }
        else
        {
            used.push_back({_file, line, name});
        }
    }

    std::string _file;
    std::string _text;
    Refusals &_refusals;
    std::size_t _at = 0;
    std::uint32_t _line = 1;
};

const std::set<std::string> &KnownToIdlc()
{
    static const std::set<std::string> names{
        "appendable", "autoid", "bit_bound", "data_representation", "default", "default_literal",
        "default_nested", "extensibility", "external", "final", "hashid", "id", "key", "max", "min",
        "mutable", "must_understand", "nested", "optional", "position", "range", "topic", "try_construct",
        "unit", "value",
        // Documentation, or texts for other languages, which the generator does not use.
        "verbatim"};
    return names;
}

}  // namespace

void RefuseWhatIdlcMisreads(const std::vector<std::string> &paths, Refusals &refusals)
{
    std::vector<Found> used;
    std::set<std::string> declared = KnownToIdlc();
    for (const std::string &path : paths)
    {
        std::ifstream file(path, std::ios::binary);
        std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
        Scanner(path, std::move(text), refusals).Run(used, declared);
    }
    for (const Found &found : used)
    {
        if (declared.count(found.Name) == 0)
        {
            refusals.Add(found.File, found.Line, "annotation @" + found.Name + " is not supported");
        }
    }
}

}  // namespace RabitIdl
