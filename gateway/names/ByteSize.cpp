#include <rabit/gateway/ByteSize.h>

#include <rabit/base/NumberIn.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace Rabit
{
namespace
{

// Each is 1000 of the one before it.
constexpr std::string_view Units[] = {"B", "kB", "MB", "GB", "TB"};

// Returns a size in the largest unit that leaves a whole number.
std::string SizeText(std::uint64_t bytes)
{
    std::size_t unit = 0;
    for (; unit + 1 < std::size(Units) && bytes != 0 && bytes % 1000 == 0; ++unit)
    {
        bytes /= 1000;
    }
    return std::to_string(bytes).append(Units[unit]);
}

}  // namespace

std::uint64_t ParseByteSize(const std::string &text, const ByteRange &range)
{
    if (text == "0" && range.Least == 0)
    {
        return 0;
    }
    const std::size_t unitAt = std::min(text.find_first_not_of("0123456789."), text.size());
    const auto *const unit =
        std::find(std::begin(Units), std::end(Units), std::string_view(text).substr(unitAt));
    const auto number = NumberIn<double>(text.substr(0, unitAt));
    if (unit == std::end(Units) || !number || !std::isfinite(*number))
    {
        throw std::invalid_argument("expected bytes such as 64MB or 1GB");
    }
    const double bytes = *number * std::pow(1000.0, unit - std::begin(Units));
    if (!(bytes >= static_cast<double>(range.Least) && bytes <= static_cast<double>(range.Most)))
    {
        throw std::invalid_argument("expected " + SizeText(range.Least) + " to " + SizeText(range.Most));
    }
    return static_cast<std::uint64_t>(bytes);
}

}  // namespace Rabit
