#pragma once

#include <array>
#include <cstdint>
#include <ctime>
#include <string>

namespace Rabit
{

// The time in UTC, by a format of strftime; empty if no calendar has it.
inline std::string UtcText(std::time_t time, const char *format)
{
    std::tm parts{};
    std::array<char, 40> text{};
    const bool isTold =
        gmtime_r(&time, &parts) != nullptr && std::strftime(text.data(), text.size(), format, &parts) != 0;
    return isTold ? text.data() : "";
}

// To the millisecond: 2026-03-01T12:00:00.250Z.
inline std::string UtcText(std::uint64_t nanoseconds)
{
    const std::string milliseconds = std::to_string(1000 + nanoseconds / 1'000'000 % 1000);
    return UtcText(static_cast<std::time_t>(nanoseconds / 1'000'000'000), "%Y-%m-%dT%H:%M:%S.") +
           milliseconds.substr(1) + "Z";
}

}  // namespace Rabit
