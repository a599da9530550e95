#include "recording/replay/TimeText.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <ctime>

namespace Rabit::Replay
{
namespace
{

constexpr Time SecondNs = 1'000'000'000;
// About 30 years: a longer time is a mistake.
constexpr double LongestSeconds = 1e9;

// Reads a number of digits and a point alone.
std::optional<double> SecondsIn(std::string_view text)
{
    double seconds = 0.0;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), seconds, std::chars_format::fixed);
    const bool isNumber = error == std::errc() && end == text.data() + text.size();
    return isNumber && seconds >= 0.0 && seconds < LongestSeconds ? std::optional(seconds) : std::nullopt;
}

Time NsOf(double seconds)
{
    return static_cast<Time>(seconds * 1e9 + 0.5);
}

}  // namespace

std::optional<Time> TimeOf(std::string_view text, Time begin)
{
    if (const auto seconds = SecondsIn(text))
    {
        return begin + NsOf(*seconds);
    }
    const std::string date(text);
    std::tm parts{};
    const char *rest = strptime(date.c_str(), "%Y-%m-%dT%H:%M:%S", &parts);
    if (rest == nullptr)
    {
        return std::nullopt;
    }
    const std::time_t whole = timegm(&parts);
    std::string_view fraction(rest);
    if (fraction.ends_with('Z'))
    {
        fraction.remove_suffix(1);
    }
    const auto part = fraction.empty() ? std::optional(0.0) : SecondsIn(fraction);
    if (whole < 0 || !part || *part >= 1.0)
    {
        return std::nullopt;
    }
    return static_cast<Time>(whole) * SecondNs + NsOf(*part);
}

std::string TextOf(Time time)
{
    const auto seconds = static_cast<std::time_t>(time / SecondNs);
    std::tm parts{};
    std::array<char, 40> date{};
    if (gmtime_r(&seconds, &parts) == nullptr ||
        std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &parts) == 0)
    {
        return "?";
    }
    std::array<char, 8> fraction{};
    std::snprintf(fraction.data(), fraction.size(), ".%03u",
                  static_cast<unsigned>(time % SecondNs / 1000000));
    return std::string(date.data()) + fraction.data();
}

}  // namespace Rabit::Replay
