#include "dynamic/JsonValues.h"

#include "dynamic/JsonText.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace Rabit::Dynamic
{
namespace
{

// The first `size` bytes of a text, cut to whole characters; all of it if it is shorter. Empty if they are
// not UTF-8.
std::string Beginning(const std::string &whole, std::size_t size)
{
    std::string cut = whole.substr(0, size);
    for (int i = 0; i < 3 && !cut.empty() && !IsUtf8(cut); ++i)
    {
        cut.pop_back();
    }
    return IsUtf8(cut) ? cut : "";
}

// The whole number that the text is in decimal digits; null if it is none, or has more than 64 bits.
nlohmann::ordered_json NumberIn(const std::string &text)
{
    const char *begin = text.data();
    const char *end = begin + text.size();
    std::uint64_t positive = 0;
    if (const auto read = std::from_chars(begin, end, positive); read.ec == std::errc() && read.ptr == end)
    {
        return positive;
    }
    std::int64_t negative = 0;
    const auto read = std::from_chars(begin, end, negative);
    return read.ec == std::errc() && read.ptr == end ? nlohmann::ordered_json(negative) : nullptr;
}

template <class T>
constexpr Range RangeOf{std::numeric_limits<T>::min(),
                        static_cast<std::uint64_t>(std::numeric_limits<T>::max())};

}  // namespace

std::string Shown(const nlohmann::ordered_json &json)
{
    if (json.is_object() || json.is_array())
    {
        return json.is_object() ? "an object" : "a list";
    }
    if (!json.is_string())
    {
        return json.dump();
    }
    const auto &whole = json.get_ref<const std::string &>();
    const std::string cut = Beginning(whole, 40);
    std::string text;
    AppendJsonText(text, cut);
    return text + (cut.size() < whole.size() ? "..." : "");
}

std::string Printable(const std::string &word)
{
    std::string text;
    AppendJsonText(text, Beginning(word, 100));
    return "`" + text.substr(1, text.size() - 2) + "`";
}

Range RangeOfKind(Kind kind)
{
    switch (kind)
    {
        case Kind::Int8:
            return RangeOf<std::int8_t>;
        case Kind::Int16:
            return RangeOf<std::int16_t>;
        case Kind::Uint16:
            return RangeOf<std::uint16_t>;
        case Kind::Int32:
            return RangeOf<std::int32_t>;
        case Kind::Uint32:
            return RangeOf<std::uint32_t>;
        case Kind::Int64:
            return RangeOf<std::int64_t>;
        case Kind::Uint64:
            return RangeOf<std::uint64_t>;
        default:
            return RangeOf<std::uint8_t>;
    }
}

bool ReadInteger(const nlohmann::ordered_json &json, const Range &range, std::uint64_t &bits)
{
    if (json.is_number_unsigned())
    {
        bits = json.get<std::uint64_t>();
        return bits <= range.Most;
    }
    if (json.is_number_integer())
    {
        const auto value = json.get<std::int64_t>();
        bits = static_cast<std::uint64_t>(value);
        return value < 0 ? value >= range.Least : bits <= range.Most;
    }
    if (json.is_string())
    {
        const auto number = NumberIn(json.get_ref<const std::string &>());
        return !number.is_null() && ReadInteger(number, range, bits);
    }
    if (!json.is_number_float())
    {
        return false;
    }
    const auto value = json.get<double>();
    constexpr double exact = 9007199254740992.0;  // 2^53: a double cannot hold all whole numbers beyond
    if (!(std::fabs(value) <= exact) || std::trunc(value) != value)
    {
        return false;
    }
    const auto whole = static_cast<std::int64_t>(value);
    bits = static_cast<std::uint64_t>(whole);
    return whole < 0 ? whole >= range.Least : bits <= range.Most;
}

bool ReadChar(const nlohmann::ordered_json &json, char &value)
{
    if (!json.is_string())
    {
        return false;
    }
    const auto &text = json.get_ref<const std::string &>();
    if (text.size() == 1)
    {
        value = text[0];
        return (value & 0x80) == 0;
    }
    const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(text[at]); };
    if (text.size() != 2 || (byte(0) != 0xc2 && byte(0) != 0xc3) || (byte(1) & 0xc0) != 0x80)
    {
        return false;
    }
    value = static_cast<char>((byte(0) & 3) << 6 | (byte(1) & 0x3f));
    return true;
}

}  // namespace Rabit::Dynamic
