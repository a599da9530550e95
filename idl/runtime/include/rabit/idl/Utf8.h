#pragma once

#include <cstddef>
#include <string_view>

namespace Rabit::Idl
{

// Bytes of the UTF-8 character that begins at a place in a text, which may hold anything; 0 if none begins
// there: no overlong form, no surrogate, nothing above U+10FFFF (RFC 3629, section 4).
std::size_t Utf8CharacterSize(std::string_view text, std::size_t at);

}  // namespace Rabit::Idl
