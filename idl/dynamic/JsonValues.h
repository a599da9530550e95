// Single values of JSON: what they are, and how they are shown in a reason.
#pragma once

#include "dynamic/Shape.h"

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
// A whole number in the range, as its bits. JSON writes 1e3 for a thousand, too.
bool ReadInteger(const nlohmann::ordered_json &json, const Range &range, std::uint64_t &bits);
// The number of a text that stands for a char: its one character, which JSON has as UTF-8.
bool ReadChar(const nlohmann::ordered_json &json, char &value);

}  // namespace Rabit::Dynamic
