#pragma once

#include <rabit/idl/Codec.h>

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace Rabit::Idl
{

// Appends values to a text for people: `{id: 3, reply_to: "ground/Commands", points: [1.5, 2]}`. Used by the
// generated ToString functions.
class TextWriter
{
public:
    // The number of elements of an array or sequence that are shown; the others are only counted.
    static constexpr std::size_t ShownElements = 16;

    const std::string &Text() const { return _text; }

    void Put(bool value) { _text += value ? "true" : "false"; }
    void Put(char value) { Quoted(std::string_view(&value, 1), '\''); }
    void Put(std::string_view value) { Quoted(value, '"'); }
    // Integers in decimal; floating point with the fewest digits that restore the value.
    template <class T,
              std::enable_if_t<
                  std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && !std::is_same_v<T, char>, int> = 0>
    void Put(T value)
    {
        char digits[32];
        const auto result = std::to_chars(digits, digits + sizeof digits, value);
        _text.append(digits, result.ptr);
    }
    // Appends the text unchanged.
    void Raw(std::string_view text) { _text += text; }

private:
    // Escapes the quote, the backslash, and all that could control a terminal: control characters (C0, DEL,
    // C1) and bytes that are not UTF-8. All other characters stay unchanged.
    void Quoted(std::string_view text, char quote);

    std::string _text;
};

// The prefix, then a value of a generated type as text.
template <class T>
std::string TextOf(std::string_view prefix, const T &value)
{
    TextWriter text;
    text.Raw(prefix);
    Codec<T>::Print(text, value);
    return text.Text();
}

}  // namespace Rabit::Idl
