#include "wire/NodeReports.h"

#include <rabit/base/Fnv1a.h>
#include <rabit/base/LittleEndian.h>

#include <vector>

namespace Rabit::NodeReports
{
namespace
{

std::string SealOf(std::string_view report)
{
    std::vector<std::uint8_t> bytes;
    LittleEndian::Put(Fnv1a().Add(report).Sum(), bytes);
    return {bytes.begin(), bytes.end()};
}

}  // namespace

std::string Sealed(std::string_view report)
{
    return SealOf(report).append(report);
}

std::optional<std::string> Opened(std::string_view text)
{
    constexpr std::size_t seal = sizeof(std::uint64_t);
    if (text.size() < seal || text.size() > seal + Largest)
    {
        return std::nullopt;
    }
    const std::string_view report = text.substr(seal);
    return SealOf(report) == text.substr(0, seal) ? std::optional<std::string>(report) : std::nullopt;
}

}  // namespace Rabit::NodeReports
