#pragma once

#include <cstddef>
#include <string_view>

namespace Rabit::Idl
{

// Size in bytes of the UTF-8 character that begins at a position in any text; 0 if none begins there.
// Overlong forms, surrogates and values above U+10FFFF are no characters (RFC 3629, section 4).
std::size_t Utf8CharacterSize(std::string_view text, std::size_t at);

}  // namespace Rabit::Idl
