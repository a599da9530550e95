#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace Rabit
{

// The number that the whole text is; empty if it is none, or does not fit. A format is one of
// std::chars_format.
template <typename Number, typename... Format>
std::optional<Number> NumberIn(std::string_view text, Format... format)
{
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, format...);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace Rabit
