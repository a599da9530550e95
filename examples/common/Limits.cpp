#include "Limits.h"

#include <array>
#include <charconv>

namespace Common
{
namespace
{
// The shortest text that tells the number from every other of its type.
template <typename Number>
std::string Text(Number value)
{
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
}

template <typename Number>
std::string WhyNotNumber(const std::string &name, Number value, const Range &range)
{
    if (range.Contains(value))
        return "";
    return name + " must be from " + Text(range.Lowest) + " to " + Text(range.Highest) + ", not " +
           Text(value);
}
}  // namespace

std::string WhyNot(const std::string &name, double value, const Range &range)
{
    return WhyNotNumber(name, value, range);
}

std::string WhyNot(const std::string &name, float value, const Range &range)
{
    return WhyNotNumber(name, value, range);
}

}  // namespace Common
