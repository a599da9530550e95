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

// Whether bytes are UTF-8: no overlong form, no surrogate, nothing above U+10FFFF.
bool IsUtf8(std::string_view text);
// Appends UTF-8 as a JSON text in quotes. Control characters are escaped: C0, DEL, and C1, with which
// terminals begin sequences, too.
void AppendJsonText(std::string &out, std::string_view utf8);
// Appends base64 (RFC 4648, padded), without quotes.
void AppendBase64(std::string &out, std::span<const std::uint8_t> bytes);
// The bytes, or nothing if it is not such a text.
std::optional<std::vector<std::uint8_t>> FromBase64(std::string_view text);

}  // namespace Rabit::Dynamic
