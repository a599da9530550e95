#include "NumberText.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace Ground
{

std::string Format(const char *format, double value)
{
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

namespace
{
constexpr double Largest = 99999;

bool IsKnown(double value)
{
    return std::isfinite(value) && value >= 0;
}

std::string Digits(double value, int decimals)
{
    if (value > Largest)
        return ">99999";
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
    return text.data();
}
}  // namespace

std::string BytesPerSecondText(double bytesPerS)
{
    if (!IsKnown(bytesPerS))
        return "-";
    if (bytesPerS < 999.5)
        return Digits(bytesPerS, 0) + " B/s";
    if (bytesPerS < 999.95e3)
        return Digits(bytesPerS / 1e3, 1) + " kB/s";
    return Digits(bytesPerS / 1e6, 1) + " MB/s";
}

std::string KiloText(double bytesPerS)
{
    if (!IsKnown(bytesPerS))
        return "-";
    const double kilo = bytesPerS / 1e3;
    return Digits(kilo, kilo < 9.995 ? 2 : kilo < 99.95 ? 1 : 0);
}

std::string PerSecondText(double perS)
{
    return IsKnown(perS) ? Digits(perS, perS < 99.95 ? 1 : 0) : "-";
}

std::string MillisecondsText(double seconds)
{
    if (!IsKnown(seconds))
        return "-";
    const double milliseconds = seconds * 1e3;
    return Digits(milliseconds, milliseconds < 9.95 ? 1 : 0);
}

}  // namespace Ground
