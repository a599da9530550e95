#include "ros/RosIdlText.h"

#include <algorithm>
#include <cctype>
#include <regex>
#include <string_view>
#include <vector>

#include "model/Names.h"

namespace RabitIdl
{
namespace
{

// Copies a text without the constructs that idlc refuses. Quoted text and comments are copied unchanged.
class Copier
{
public:
    explicit Copier(const std::string &text) : _text(text) {}

    std::string Run()
    {
        while (_at < _text.size())
        {
            if (!CopyQuoted() && !SkipVerbatim() && !CopyWord())
            {
                CopyOne();
            }
        }
        return std::move(_out);
    }

private:
    bool StartsWith(const char *word) const
    {
        return _text.compare(_at, std::char_traits<char>::length(word), word) == 0;
    }

    // The end of the string or comment that begins here; the current position if there is none.
    std::size_t EndOfQuoted() const
    {
        if (StartsWith("//"))
        {
            return std::min(_text.find('\n', _at), _text.size());
        }
        if (StartsWith("/*"))
        {
            const std::size_t end = _text.find("*/", _at + 2);
            return end == std::string::npos ? _text.size() : end + 2;
        }
        if (_text[_at] != '"')
        {
            return _at;
        }
        std::size_t end = _at + 1;
        while (end < _text.size() && _text[end] != '"')
        {
            end += _text[end] == '\\' ? 2 : 1;
        }
        return std::min(end + 1, _text.size());
    }

    bool CopyQuoted()
    {
        const std::size_t end = EndOfQuoted();
        if (end == _at)
        {
            return false;
        }
        _out.append(_text, _at, end - _at);
        _at = end;
        return true;
    }

    // Skips an @verbatim, but keeps its line breaks, so that the other lines keep their numbers.
    bool SkipVerbatim()
    {
        if (!StartsWith("@verbatim"))
        {
            return false;
        }
        int depth = 0;
        do
        {
            const std::size_t end = std::max(EndOfQuoted(), _at + 1);
            depth += _text[_at] == '(' ? 1 : _text[_at] == ')' ? -1 : 0;
            const bool closed = _text[_at] == ')' && depth == 0;
            for (; _at < end; ++_at)
            {
                _out += _text[_at] == '\n' ? "\n" : "";
            }
            if (closed)
            {
                break;
            }
        } while (_at < _text.size());
        return true;
    }

    static bool IsLetter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

    // Copies a word. A name that IDL would take for a keyword is escaped.
    bool CopyWord()
    {
        std::size_t end = _at;
        while (end < _text.size() && IsLetter(_text[end]))
        {
            ++end;
        }
        if (end == _at)
        {
            return false;
        }
        const std::string word = _text.substr(_at, end - _at);
        _out += IsIdlKeyword(word) && (!IsWrittenAsKeyword(word) || IsName(end)) ? "_" : "";
        _out += word;
        _at = end;
        return true;
    }

    static bool IsWrittenAsKeyword(const std::string &word)
    {
        return word == "TRUE" || word == "FALSE" ||
               std::none_of(word.begin(), word.end(),
                            [](unsigned char letter) { return std::isupper(letter) != 0; });
    }

    // True if the word that ends there is a declared name: it stands behind a type, and is followed as a
    // name is.
    bool IsName(std::size_t end) const
    {
        const std::size_t next = _text.find_first_not_of(" \t", end);
        const bool endsHere =
            next != std::string::npos && std::string_view(";=[").find(_text[next]) != std::string_view::npos;
        const std::size_t before = _out.find_last_not_of(" \t");
        return endsHere && before != std::string::npos && (IsLetter(_out[before]) || _out[before] == '>') &&
               before + 1 < _out.size();
    }

    void CopyOne()
    {
        _out += _text[_at];
        _out += StartsWith(">>") ? " " : "";
        ++_at;
    }

    const std::string &_text;
    std::size_t _at = 0;
    std::string _out;
};

std::string Joined(const std::vector<std::string> &modules)
{
    std::string text;
    for (const std::string &module : modules)
    {
        text += module + "_";
    }
    return text;
}

}  // namespace

std::string RosIdlText(const std::string &text)
{
    static const std::regex module(R"(^\s*module\s+(\w+)\s*\{\s*$)");
    static const std::regex opens(R"(^[^"]*\{\s*$)");
    static const std::regex closes(R"(^\s*\}\s*;\s*$)");
    static const std::regex alias(R"(^\s*typedef\s.*?(\w+)\s*(\[\d+\])?\s*;\s*$)");
    const std::string copied = Copier(text).Run();
    std::vector<std::string> scopes;
    std::string out;
    for (std::size_t at = 0; at < copied.size();)
    {
        const std::size_t end = std::min(copied.find('\n', at), copied.size());
        const std::string line = copied.substr(at, end - at);
        at = end + 1;
        std::smatch found;
        if (std::regex_match(line, found, module))
        {
            scopes.push_back(found[1]);
        }
        else if (std::regex_match(line, opens))
        {
            scopes.emplace_back();
        }
        else if (std::regex_match(line, closes) && !scopes.empty())
        {
            scopes.pop_back();
        }
        if (std::regex_match(line, found, alias) && found[1].str().find("__") != std::string::npos)
        {
            const std::string guard = "RABIT_TYPEDEF_" + Joined(scopes) + found[1].str();
            out += "#ifndef " + guard + "\n#define " + guard + "\n" + line + "\n#endif\n";
        }
        else
        {
            out += line + "\n";
        }
    }
    return out;
}

}  // namespace RabitIdl
