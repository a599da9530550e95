// Steps through tokens and refuses unexpected ones.
#pragma once

#include "dynamic/IdlTokens.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit::Dynamic
{

// Thrown from any depth of the grammar: the reason, with its line.
struct NotGrammatical : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

class TokenCursor
{
public:
    // The last token is End; they must outlive the cursor.
    explicit TokenCursor(const std::vector<Token> &tokens) : _tokens(tokens) {}

    const Token &Now() const { return _tokens[_at]; }
    bool Is(char sign) const { return Now().What == Token::Kind::Sign && Now().Text[0] == sign; }
    bool IsWord(std::string_view word) const { return Now().What == Token::Kind::Word && Now().Text == word; }
    bool IsAnnotation(std::string_view name) const
    {
        return Now().What == Token::Kind::Annotation && Now().Text == name;
    }

    [[noreturn]] void Refuse(const std::string &reason) const;
    [[noreturn]] void Expected(const std::string &what) const;

    // Moves to the next token. Must not be called at End.
    void Step() { ++_at; }
    void Sign(char sign);
    // If the token is that word, steps past it and returns true.
    bool TakeWord(std::string_view word);
    // Reads a declared name, or a part of one. Keywords of IDL are refused unless an underscore precedes
    // them.
    void Name();
    void ScopedName();
    std::uint64_t Number(std::uint64_t least, std::uint64_t most);
    // Reads a value, as in a label or @default. withTexts: also real numbers and texts.
    void Literal(bool withTexts);

private:
    const std::vector<Token> &_tokens;
    std::size_t _at = 0;
};

}  // namespace Rabit::Dynamic
