// Pieces of JSON text.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit::Dynamic
{

// True if the bytes are UTF-8: no overlong form, no surrogate, nothing above U+10FFFF.
bool IsUtf8(std::string_view text);
// Appends UTF-8 as a JSON text in quotes. Control characters are escaped: C0, DEL, and C1, which can begin
// a terminal sequence.
void AppendJsonText(std::string &out, std::string_view utf8);
// Appends base64 (RFC 4648, padded), without quotes.
void AppendBase64(std::string &out, std::span<const std::uint8_t> bytes);
// Returns the bytes, or nothing if the text is not base64.
std::optional<std::vector<std::uint8_t>> FromBase64(std::string_view text);

}  // namespace Rabit::Dynamic
