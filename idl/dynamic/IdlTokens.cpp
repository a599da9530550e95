#include "dynamic/IdlTokens.h"

#include "dynamic/Limits.h"

#include <utility>

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

class Reader
{
public:
    explicit Reader(std::string_view text) : _text(text) {}

    std::vector<Token> Run(std::string &reason)
    {
        if (_text.size() > MaxTextSize)
        {
            reason = "the text has more than " + std::to_string(MaxTextSize) + " bytes";
            return {};
        }
        while (_reason.empty() && _at < _text.size())
        {
            Next();
            if (_reason.empty() && _tokens.size() > MaxTokens)
            {
                Refuse("the text has more than " + std::to_string(MaxTokens) + " words and signs");
            }
        }
        reason = _reason;
        Add(Token::Kind::End, _at);
        return reason.empty() ? std::move(_tokens) : std::vector<Token>();
    }

private:
    char Peek(std::size_t ahead) const { return _at + ahead < _text.size() ? _text[_at + ahead] : '\0'; }

    void Refuse(const std::string &reason) { _reason = "line " + std::to_string(_line) + ": " + reason; }

    void Add(Token::Kind kind, std::size_t begin)
    {
        _tokens.push_back({kind, _text.substr(begin, _at - begin), _line});
    }

    void Next()
    {
        const char letter = _text[_at];
        if (letter == '\n' || letter == ' ' || letter == '\t')
        {
            _line += letter == '\n' ? 1 : 0;
            ++_at;
        }
        else if (letter == '/')
        {
            Comment();
        }
        else if (IsNameStart(letter))
        {
            Word(Token::Kind::Word);
        }
        else if (letter == '@')
        {
            ++_at;
            Word(Token::Kind::Annotation);
        }
        else if (IsDigit(letter))
        {
            Number();
        }
        else if (letter == '"' || letter == '\'')
        {
            Quoted(letter);
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

    void Word(Token::Kind kind)
    {
        const std::size_t begin = _at;
        while (IsNameStart(Peek(0)) || IsDigit(Peek(0)))
        {
            ++_at;
        }
        if (_at - begin > MaxNameLength)
        {
            Refuse("a name has more than " + std::to_string(MaxNameLength) + " letters");
        }
        Add(kind, begin);
    }

    // Reads a decimal number. Leading zeros are refused: they begin octal and hexadecimal numbers.
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
        Add(isWhole ? Token::Kind::Integer : Token::Kind::Real, begin);
    }

    // Printable ASCII on one line; escapes are quotes, the backslash and three octal digits.
    void Quoted(char quote)
    {
        const std::size_t begin = _at;
        std::size_t count = 0;
        for (++_at; Peek(0) != quote; ++count)
        {
            const char letter = Peek(0);
            if (letter < ' ' || letter > '~')
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
        Add(quote == '\'' ? Token::Kind::Character : Token::Kind::Text, begin);
    }

    void Sign(char letter)
    {
        static constexpr std::string_view signs = "(){}[]<>;,:-";
        if (signs.find(letter) == signs.npos)
        {
            Refuse(letter > 0x20 && letter < 0x7f ? "unexpected '" + std::string(1, letter) + "'"
                                                  : "a character is not printable ASCII");
            return;
        }
        const std::size_t begin = _at++;
        if (letter == ':' && Peek(0) == ':')
        {
            ++_at;
            Add(Token::Kind::Scope, begin);
            return;
        }
        if ((letter == '<' || letter == '>') && Peek(0) == letter)
        {
            Refuse("two angle brackets side by side, which idlc takes for a shift");
        }
        Add(Token::Kind::Sign, begin);
    }

    std::string_view _text;
    std::string _reason;
    std::size_t _at = 0;
    std::size_t _line = 1;
    std::vector<Token> _tokens;
};

}  // namespace

std::vector<Token> TokensOf(std::string_view idlText, std::string &reason)
{
    return Reader(idlText).Run(reason);
}

}  // namespace Rabit::Dynamic
