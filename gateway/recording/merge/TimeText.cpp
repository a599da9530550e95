#include "recording/merge/TimeText.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace Rabit::Merge
{
namespace
{

// Reads a fraction of a second, as nanoseconds. Nothing but a Z may follow it.
std::optional<Moment> ParseFraction(const char *text)
{
    Moment fraction = 0;
    if (*text == '.')
    {
        ++text;
        for (Moment unit = OneSecond / 10; *text >= '0' && *text <= '9'; ++text, unit /= 10)
        {
            fraction += unit * (*text - '0');
        }
    }
    text += *text == 'Z' ? 1 : 0;
    return *text == '\0' ? std::optional(fraction) : std::nullopt;
}

std::optional<Moment> ParseDate(const std::string &text)
{
    std::tm parts{};
    char between = 0;
    int length = 0;
    if (std::sscanf(text.c_str(), "%4d-%2d-%2d%c%2d:%2d:%2d%n", &parts.tm_year, &parts.tm_mon, &parts.tm_mday,
                    &between, &parts.tm_hour, &parts.tm_min, &parts.tm_sec, &length) != 7 ||
        (between != 'T' && between != ' '))
    {
        return std::nullopt;
    }
    parts.tm_year -= 1900;
    parts.tm_mon -= 1;
    const std::tm said = parts;
    const std::time_t seconds = timegm(&parts);
    const bool isDate = parts.tm_mday == said.tm_mday && parts.tm_mon == said.tm_mon &&
                        parts.tm_hour == said.tm_hour && parts.tm_min == said.tm_min &&
                        parts.tm_sec == said.tm_sec;
    const auto fraction = ParseFraction(text.c_str() + length);
    return isDate && fraction ? std::optional(Within(Moment{seconds} * OneSecond + *fraction)) : std::nullopt;
}

}  // namespace

std::optional<Moment> ParseMoment(const std::string &text, Moment beginning)
{
    char *end = nullptr;
    const double seconds = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && std::isfinite(seconds))
    {
        return Within(beginning + PartOf(OneSecond, seconds));
    }
    return ParseDate(text);
}

std::string DateOf(Moment moment)
{
    const Moment seconds = moment / OneSecond;
    const auto time = static_cast<std::time_t>(seconds);
    std::tm parts{};
    std::array<char, 40> date{};
    std::array<char, 64> text{};
    if (moment < 0 || gmtime_r(&time, &parts) == nullptr ||
        std::strftime(date.data(), date.size(), "%Y-%m-%d %H:%M:%S", &parts) == 0)
    {
        return "?";
    }
    std::snprintf(text.data(), text.size(), "%s.%03d UTC", date.data(),
                  static_cast<int>((moment - seconds * OneSecond) / 1000000));
    return text.data();
}

}  // namespace Rabit::Merge
