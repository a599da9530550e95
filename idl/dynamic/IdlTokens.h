// The tokens of an untrusted IDL text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit::Dynamic
{

struct Token
{
    enum class Kind
    {
        Word,
        Integer,  // decimal, without sign and leading zeros
        Real,
        Text,        // with its quotes
        Character,   // with its quotes
        Annotation,  // its name, without @
        Scope,       // ::
        Sign,
        End
    };
    Kind What = Kind::End;
    std::string_view Text;  // points into the text
    std::size_t Line = 0;
};

// Returns all tokens without comments, End last. If the text has an unsupported character, number or
// escape, or exceeds a limit, returns none and sets the reason. Time and memory are linear in the text,
// which must outlive the tokens.
std::vector<Token> TokensOf(std::string_view idlText, std::string &reason);

}  // namespace Rabit::Dynamic
