// Single values of JSON: reading them, and showing them in the reason of a refusal.
#pragma once

#include <rabit/dynamic/Shape.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

namespace Rabit::Dynamic
{

// A piece of the caller's JSON for a line of text: short, quoted, without control characters.
std::string Shown(const nlohmann::ordered_json &json);
// A name from JSON for a line of text.
std::string Printable(const std::string &word);

// Values of an integer type.
struct Range
{
    std::int64_t Least;
    std::uint64_t Most;
};
Range RangeOfKind(Kind kind);
// Reads a whole number in the range, as its bits. JSON may also write 1000 as 1e3 or "1000".
bool ReadInteger(const nlohmann::ordered_json &json, const Range &range, std::uint64_t &bits);
// Reads a char from a text of one character, which JSON has as UTF-8.
bool ReadChar(const nlohmann::ordered_json &json, char &value);

}  // namespace Rabit::Dynamic
