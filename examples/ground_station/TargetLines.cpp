#include "TargetLines.h"

#include "FleetTable.h"
#include "NumberText.h"
#include "WireNames.h"

#include <boost/algorithm/string/case_conv.hpp>

#include <array>
#include <cstdio>

namespace Ground
{
namespace
{
constexpr std::size_t LongestAircraft = 20;
}

std::string ToText(Uav::TargetStage stage)
{
    return boost::algorithm::to_upper_copy(WireName(stage));
}

std::string NameOf(const Uav::TargetName &name)
{
    return Printable(name.aircraft, LongestAircraft) + "/" + std::to_string(name.number);
}

std::string NameOf(const FoundTarget &target)
{
    return NameOf(target.Finding.name);
}

std::string TargetLine(const FoundTarget &target)
{
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "target %-8s %-10s %10.5f %11.5f", NameOf(target).c_str(),
                  ToText(target.Finding.stage).c_str(), target.Finding.latitude_deg,
                  target.Finding.longitude_deg);
    std::string line = text.data();
    if (!target.Finding.validated_by.empty())
        line += "  validated by " + Printable(target.Finding.validated_by, LongestAircraft);
    if (target.Finding.tracked_s > 0)
        line += Format(", followed for %.0f s", static_cast<double>(target.Finding.tracked_s));
    for (const Uav::TargetName &name : target.Formerly)
        line += ", was also " + NameOf(name);
    return line;
}

bool IsTracked(const FoundTarget &target)
{
    const Uav::Finding &finding = target.Finding;
    return finding.stage == Uav::TargetStage::TARGET_TRACKED && finding.tracked_s > 0 &&
           !finding.validated_by.empty() && finding.validated_by != target.Aircraft;
}

}  // namespace Ground
