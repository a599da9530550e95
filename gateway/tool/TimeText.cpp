#include "TimeText.h"

#include <rabit/base/NumberIn.h>

#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "Table.h"

namespace Rabit::Tool
{
namespace
{

constexpr std::uint64_t SecondNs = 1'000'000'000;
// About 30 years: a longer time is a mistake.
constexpr double LongestSeconds = 1e9;
constexpr std::string_view Form = "dddd-dd-ddTdd:dd:dd";

constexpr bool IsDigit(char c)
{
    return c >= '0' && c <= '9';
}

// Reads a number of digits and a point alone, as nanoseconds.
std::optional<std::uint64_t> SecondsIn(std::string_view text)
{
    const auto seconds = NumberIn<double>(text, std::chars_format::fixed);
    return seconds && *seconds >= 0.0 && *seconds < LongestSeconds
               ? std::optional(static_cast<std::uint64_t>(*seconds * 1e9 + 0.5))
               : std::nullopt;
}

// Reads `.25`, or nothing, as nanoseconds.
std::optional<std::uint64_t> FractionIn(std::string_view text)
{
    if (text.empty())
    {
        return 0;
    }
    if (text.front() != '.' || text.size() == 1)
    {
        return std::nullopt;
    }
    std::uint64_t fraction = 0;
    std::uint64_t unit = SecondNs / 10;
    for (const char c : text.substr(1))
    {
        if (!IsDigit(c))
        {
            return std::nullopt;
        }
        fraction += unit * static_cast<std::uint64_t>(c - '0');
        unit /= 10;
    }
    return fraction;
}

bool HasForm(std::string_view date)
{
    for (std::size_t i = 0; i < Form.size(); ++i)
    {
        const bool isGood = Form[i] == 'd'   ? IsDigit(date[i])
                            : Form[i] == 'T' ? date[i] == 'T' || date[i] == ' '
                                             : date[i] == Form[i];
        if (!isGood)
        {
            return false;
        }
    }
    return true;
}

// Reads a date of that form, as seconds since 1970.
std::optional<std::uint64_t> SecondsOfDate(std::string_view date)
{
    if (date.size() != Form.size() || !HasForm(date))
    {
        return std::nullopt;
    }
    const auto number = [date](std::size_t at, std::size_t digits)
    {
        int value = 0;
        for (const char c : date.substr(at, digits))
        {
            value = 10 * value + (c - '0');
        }
        return value;
    };
    const std::chrono::year_month_day day(std::chrono::year(number(0, 4)),
                                          std::chrono::month(static_cast<unsigned>(number(5, 2))),
                                          std::chrono::day(static_cast<unsigned>(number(8, 2))));
    const int hour = number(11, 2);
    const int minute = number(14, 2);
    const int second = number(17, 2);
    if (!day.ok() || hour > 23 || minute > 59 || second > 59)
    {
        return std::nullopt;
    }
    const std::chrono::seconds seconds = std::chrono::sys_days(day).time_since_epoch() +
                                         std::chrono::hours(hour) + std::chrono::minutes(minute) +
                                         std::chrono::seconds(second);
    return seconds.count() < 0 ? std::nullopt : std::optional(static_cast<std::uint64_t>(seconds.count()));
}

// Nothing if the sum does not fit.
std::optional<std::uint64_t> Later(std::uint64_t time, std::uint64_t by)
{
    return by <= std::numeric_limits<std::uint64_t>::max() - time ? std::optional(time + by) : std::nullopt;
}

}  // namespace

std::optional<std::uint64_t> TimeOf(std::string_view text, std::uint64_t begin)
{
    if (const auto seconds = SecondsIn(text))
    {
        return Later(begin, *seconds);
    }
    if (text.ends_with('Z'))
    {
        text.remove_suffix(1);
    }
    const auto seconds = SecondsOfDate(text.substr(0, Form.size()));
    const auto fraction = seconds ? FractionIn(text.substr(Form.size())) : std::nullopt;
    constexpr std::uint64_t latest = std::numeric_limits<std::uint64_t>::max() / SecondNs;
    return fraction && *seconds < latest ? std::optional(*seconds * SecondNs + *fraction) : std::nullopt;
}

std::string DurationText(double seconds)
{
    struct Unit
    {
        double Below;  // seconds
        double Length;
        int Digits;
        const char *Name;
    };
    constexpr double minute = 60.0;
    constexpr double hour = 60.0 * minute;
    constexpr std::array<Unit, 4> units = {{{1.0, 0.001, 2, " ms"},
                                            {2.0 * minute, 1.0, 2, " s"},
                                            {2.0 * hour, minute, 1, " min"},
                                            {std::numeric_limits<double>::infinity(), hour, 1, " h"}}};
    for (const Unit &unit : units)
    {
        if (std::abs(seconds) < unit.Below)
        {
            return NumberText(seconds / unit.Length, unit.Digits, unit.Name);
        }
    }
    return "-";
}

}  // namespace Rabit::Tool
