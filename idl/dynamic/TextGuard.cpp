#include "dynamic/TextGuard.h"

#include "dynamic/Limits.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

namespace Rabit::Dynamic
{
namespace
{

bool IsDigit(char letter)
{
    return letter >= '0' && letter <= '9';
}
bool IsOctal(char letter)
{
    return letter >= '0' && letter <= '7';
}
bool IsNameStart(char letter)
{
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || letter == '_';
}

template <std::size_t Count>
bool IsOneOf(std::string_view word, const std::array<std::string_view, Count> &words)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

// What definitions begin with, and what would make them another language.
constexpr std::array<std::string_view, 5> Definitions{"struct", "union", "enum", "bitmask", "typedef"};
constexpr std::array<std::string_view, 11> Annotations{
    "final", "appendable", "nested", "key",  "default",  "default_literal",
    "value", "position",   "id",     "unit", "bit_bound"};

class Guard
{
public:
    explicit Guard(std::string_view text) : _text(text) {}

    std::string Run()
    {
        if (_text.size() > MaxTextSize)
        {
            return "the text has more than " + std::to_string(MaxTextSize) + " bytes";
        }
        while (_reason.empty() && _at < _text.size())
        {
            Token();
            if (_reason.empty() && _tokens > MaxTokens)
            {
                Refuse("the text has more than " + std::to_string(MaxTokens) + " words and signs");
            }
        }
        if (_reason.empty() && _depth != 0)
        {
            Refuse("a bracket is not closed");
        }
        return _reason;
    }

private:
    char Peek(std::size_t ahead) const { return _at + ahead < _text.size() ? _text[_at + ahead] : '\0'; }

    void Refuse(const std::string &reason) { _reason = "line " + std::to_string(_line) + ": " + reason; }

    void Token()
    {
        const char letter = _text[_at];
        if (letter == '\n' || letter == ' ' || letter == '\t')
        {
            _line += letter == '\n' ? 1 : 0;
            ++_at;
            return;
        }
        if (letter == '/')
        {
            Comment();
            return;
        }
        ++_tokens;
        if (IsNameStart(letter))
        {
            Name();
        }
        else if (IsDigit(letter))
        {
            Number();
        }
        else if (letter == '"' || letter == '\'')
        {
            Quoted(letter);
        }
        else if (letter == '@')
        {
            Annotation();
        }
        else
        {
            Sign(letter);
        }
    }

    void Comment()
    {
        const bool isBlock = Peek(1) == '*';
        if (!isBlock && Peek(1) != '/')
        {
            Refuse("unexpected '/'");
            return;
        }
        const std::size_t end = _text.find(isBlock ? "*/" : "\n", _at + 2);
        const std::size_t stop = end == _text.npos ? _text.size() : end + (isBlock ? 2 : 0);
        if (isBlock && end == _text.npos)
        {
            Refuse("a comment is not closed");
            return;
        }
        for (; _at < stop; ++_at)
        {
            const auto code = static_cast<unsigned char>(_text[_at]);
            if (code == '\\' || code == 0x7f || (code < 0x20 && code != '\n' && code != '\t'))
            {
                Refuse("a comment has a character that is not supported");
                return;
            }
            _line += _text[_at] == '\n' ? 1 : 0;
        }
    }

    std::string_view Word()
    {
        const std::size_t begin = _at;
        while (_at < _text.size() && (IsNameStart(_text[_at]) || IsDigit(_text[_at])))
        {
            ++_at;
        }
        if (_at - begin > MaxNameLength)
        {
            Refuse("a name has more than " + std::to_string(MaxNameLength) + " letters");
        }
        return _text.substr(begin, _at - begin);
    }

    void Name()
    {
        const std::string_view word = Word();
        _definitions += IsOneOf(word, Definitions) ? 1 : 0;
        _modules += word == "module" ? 1 : 0;
        if (_definitions > MaxDefinitions || _modules > 8 * MaxDefinitions)
        {
            Refuse("more than " + std::to_string(MaxDefinitions) + " definitions");
        }
    }

    // Decimal, without leading zeros, with which others begin octal and hexadecimal.
    void Number()
    {
        const std::size_t begin = _at;
        const auto digits = [&]
        {
            while (IsDigit(Peek(0)))
            {
                ++_at;
            }
        };
        digits();
        const bool isWhole = Peek(0) != '.' && Peek(0) != 'e' && Peek(0) != 'E';
        if (Peek(0) == '.')
        {
            ++_at;
            digits();
        }
        if (Peek(0) == 'e' || Peek(0) == 'E')
        {
            _at += Peek(1) == '-' || Peek(1) == '+' ? 2 : 1;
            if (!IsDigit(Peek(0)))
            {
                Refuse("a number ends in its exponent");
            }
            digits();
        }
        const std::size_t size = _at - begin;
        if (IsNameStart(Peek(0)) || Peek(0) == '.' || size > (isWhole ? 20U : 40U) ||
            (isWhole && size > 1 && _text[begin] == '0'))
        {
            Refuse("a number is not a plain decimal one");
        }
    }

    // Printable ASCII on one line; escapes are quotes, the backslash and three octal digits.
    void Quoted(char quote)
    {
        std::size_t count = 0;
        for (++_at; Peek(0) != quote; ++count)
        {
            const char letter = Peek(0);
            if (letter < 0x20 || letter == 0x7f)
            {
                Refuse("a text or character is not closed, or not printable");
                return;
            }
            if (letter != '\\')
            {
                ++_at;
            }
            else if (Peek(1) == '\\' || Peek(1) == '"' || Peek(1) == '\'')
            {
                _at += 2;
            }
            else if (Peek(1) >= '0' && Peek(1) <= '3' && IsOctal(Peek(2)) && IsOctal(Peek(3)) &&
                     _text.substr(_at + 1, 3) != "000")
            {
                _at += 4;
            }
            else
            {
                Refuse("an escape is not supported");
                return;
            }
        }
        ++_at;
        if ((quote == '\'' && count != 1) || count > MaxStringLength)
        {
            Refuse(quote == '\'' ? "a character is not one"
                                 : "a text has more than " + std::to_string(MaxStringLength) + " bytes");
        }
    }

    void Annotation()
    {
        ++_at;
        const std::string word(Word());
        if (!IsOneOf(word, Annotations))
        {
            Refuse("annotation '@" + word + "' is not supported in a text to be read at run time");
        }
    }

    void Sign(char letter)
    {
        static constexpr std::string_view opening = "({[<";
        static constexpr std::string_view closing = ")}]>";
        const std::size_t closes = closing.find(letter);
        if (opening.find(letter) != opening.npos)
        {
            if (_depth == MaxBrackets)
            {
                Refuse("more than " + std::to_string(MaxBrackets) + " brackets within each other");
                return;
            }
            _open[_depth++] = closing[opening.find(letter)];
        }
        else if (closes != closing.npos)
        {
            if (_depth == 0 || _open[_depth - 1] != letter)
            {
                Refuse("unexpected '" + std::string(1, letter) + "'");
                return;
            }
            --_depth;
        }
        else if (letter == ';' || letter == ',')
        {
            if (++_parts > MaxParts)
            {
                Refuse("more than " + std::to_string(MaxParts) + " members, values and definitions");
                return;
            }
        }
        else if (letter == '-')
        {
            if (!IsDigit(Peek(1)))
            {
                Refuse("unexpected '-'");
                return;
            }
        }
        else if (letter != ':')
        {
            Refuse(letter > 0x20 && letter < 0x7f ? "unexpected '" + std::string(1, letter) + "'"
                                                  : "a character is not printable ASCII");
            return;
        }
        ++_at;
    }

    std::string_view _text;
    std::string _reason;
    std::size_t _at = 0;
    std::size_t _line = 1;
    std::size_t _tokens = 0;
    std::size_t _definitions = 0;
    std::size_t _modules = 0;
    std::size_t _parts = 0;
    std::array<char, MaxBrackets> _open{};
    std::size_t _depth = 0;
};

}  // namespace

std::string WhyNotParsed(std::string_view idlText)
{
    return Guard(idlText).Run();
}

}  // namespace Rabit::Dynamic
