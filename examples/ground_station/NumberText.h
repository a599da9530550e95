// Numbers for an operator: few digits, and a short text for every number.
#pragma once

#include <string>

namespace Ground
{

// Writes a number by a format of printf, such as `%.1f m`; 63 characters at most.
std::string Format(const char *format, double value);

// `-`: not known (not finite, or negative).

// Bytes a second, with the unit: `850 B/s`, `3.2 kB/s`, `1.5 MB/s`.
std::string BytesPerSecondText(double bytesPerS);
// The same as a bare number of kB/s, for a column or a list: `0.85`, `12.5`, `340`.
std::string KiloText(double bytesPerS);
// Events a second: `0.5`, `10.0`, `250`.
std::string PerSecondText(double perS);
// Milliseconds: `0.9`, `12`, `1500`.
std::string MillisecondsText(double seconds);

}  // namespace Ground
