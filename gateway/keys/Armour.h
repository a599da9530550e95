// Bytes as text: PEM (RFC 7468) with labels of our own. Text survives mail and the clipboard, and people see
// what it is.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit::Keys
{

using Bytes = std::vector<std::uint8_t>;

std::string Armoured(const std::string &label, std::span<const std::uint8_t> bytes);

// Return the bytes of all blocks in a text, in their order, or of the only one. Accept any text. Throw
// KeysError, which names `file`, unless there is a block (one) and each has that label.
std::vector<Bytes> BlocksIn(std::string_view text, const std::string &label, const std::string &file);
Bytes BlockIn(std::string_view text, const std::string &label, const std::string &file);

}  // namespace Rabit::Keys
