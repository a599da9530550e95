#include "dynamic/TokenCursor.h"

#include "model/Names.h"

#include <charconv>
#include <limits>

namespace Rabit::Dynamic
{

void TokenCursor::Refuse(const std::string &reason) const
{
    throw NotGrammatical("line " + std::to_string(Now().Line) + ": " + reason);
}

void TokenCursor::Expected(const std::string &what) const
{
    Refuse("expected " + what +
           (Now().What == Token::Kind::End ? ", not the end" : ", not '" + std::string(Now().Text) + "'"));
}

void TokenCursor::Sign(char sign)
{
    if (!Is(sign))
    {
        Expected("'" + std::string(1, sign) + "'");
    }
    ++_at;
}

bool TokenCursor::TakeWord(std::string_view word)
{
    const bool is = IsWord(word);
    _at += is ? 1 : 0;
    return is;
}

void TokenCursor::Name()
{
    if (Now().What != Token::Kind::Word)
    {
        Expected("a name");
    }
    const std::string name(Now().Text);
    const bool isEscaped = name[0] == '_';
    const char first = name.size() > (isEscaped ? 1U : 0U) ? name[isEscaped ? 1 : 0] : '_';
    if ((!isEscaped && RabitIdl::IsIdlKeyword(name)) || first == '_' || (first >= '0' && first <= '9'))
    {
        Expected("a name");
    }
    ++_at;
}

void TokenCursor::ScopedName()
{
    if (Now().What == Token::Kind::Scope)
    {
        ++_at;
    }
    Name();
    while (Now().What == Token::Kind::Scope)
    {
        ++_at;
        Name();
    }
}

std::uint64_t TokenCursor::Number(std::uint64_t least, std::uint64_t most)
{
    std::uint64_t value = 0;
    const std::string_view text = Now().Text;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (Now().What != Token::Kind::Integer || result.ec != std::errc() || value < least || value > most)
    {
        Expected("a number from " + std::to_string(least) + " to " + std::to_string(most));
    }
    ++_at;
    return value;
}

void TokenCursor::Literal(bool withTexts)
{
    const Token::Kind kind = Now().What;
    if (kind == Token::Kind::Character ||
        (withTexts && (kind == Token::Kind::Real || kind == Token::Kind::Text)) || IsWord("TRUE") ||
        IsWord("FALSE"))
    {
        ++_at;
    }
    else if (Is('-'))
    {
        ++_at;
        if (withTexts && Now().What == Token::Kind::Real)
        {
            ++_at;
            return;
        }
        Number(0, std::uint64_t{1} << 63);
    }
    else
    {
        Number(0, std::numeric_limits<std::uint64_t>::max());
    }
}

}  // namespace Rabit::Dynamic
