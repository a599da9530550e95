// The words and signs of an IDL text from a stranger.
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
    std::string_view Text;  // in the text that was read
    std::size_t Line = 0;
};

// All of them, End last; comments are left out. Nothing and a reason if the text has a character, a number or
// an escape that is not supported, or exceeds a limit. Time and memory are linear in the text, which must
// outlive the tokens.
std::vector<Token> TokensOf(std::string_view idlText, std::string &reason);

}  // namespace Rabit::Dynamic
