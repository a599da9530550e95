#include "RadioLines.h"

#include "NodeState.h"
#include "NumberText.h"
#include "WrappedLines.h"

#include <rabit/gateway/ClassRates.h>

namespace Ground
{
namespace
{
std::string Limits(const Rabit::Gateway::AirStatus &air)
{
    std::string text;
    if (air.budget > 0)
        text.append("budget ").append(BytesPerSecondText(air.budget));
    if (air.capacity > 0)
        text.append(text.empty() ? "the air carries " : ", the air carries ")
            .append(BytesPerSecondText(air.capacity));
    return text.empty() ? "not limited" : text;
}

// `3.8 posts/s, 3 queue messages`; empty if nothing is held back.
std::string Held(const RadioUse &use)
{
    std::string text;
    if (!use.Streams.empty())
        text = PerSecondText(use.PostsHeldPerS) + " posts/s";
    if (use.MessagesHeld > 0)
        text.append(text.empty() ? "" : ", ")
            .append(std::to_string(use.MessagesHeld))
            .append(use.MessagesHeld == 1 ? " queue message" : " queue messages");
    return text;
}

std::string Summary(const RadioUse &use, double fleetAgeS)
{
    std::string text = Limits(use.Air) + ", " + BytesPerSecondText(use.Air.used) + " used";
    const std::string held = Held(use);
    if (!held.empty())
        text += "; held back: " + held;
    if (fleetAgeS > FleetFreshS)
        text.append(" (").append(Format("%.0f s", fleetAgeS)).append(" ago)");
    return text;
}

std::vector<std::string> Classes(const Rabit::Gateway::AirStatus &air)
{
    std::vector<std::string> parts;
    const auto add = [&parts](const char *name, double bytesPerS)
    {
        if (bytesPerS > 0)
            parts.push_back(std::string(name).append(" ").append(KiloText(bytesPerS)));
    };
    for (const auto &[name, rate] : Rabit::ClassRates)
        add(name, air.*rate);
    add("discovery", air.discovery);
    return parts;
}

std::string LineOf(const HeldLink &link)
{
    std::string text = Printable(link.Node, LongestName) + "/" + Printable(link.Queue, LongestName) + ": " +
                       std::to_string(link.Waiting) + (link.Waiting == 1 ? " waits" : " wait");
    if (link.Expired > 0)
        text.append(", ").append(std::to_string(link.Expired)).append(" expired");
    return text;
}

std::string LineOf(const HeldStream &stream)
{
    return Printable(stream.Message, LongestName) + ": " + PerSecondText(stream.PostedPerS) + "/s posted, " +
           PerSecondText(stream.SentPerS) + "/s sent";
}

// Commands first.
std::vector<std::string> HeldByName(const RadioUse &use)
{
    std::vector<std::string> lines;
    const auto add = [&lines](const auto &held)
    {
        for (const auto &one : held)
        {
            if (lines.size() == HeldOnScreen)
                return;
            lines.push_back(LineOf(one));
        }
    };
    add(use.Links);
    add(use.Streams);
    const std::size_t all = use.Links.size() + use.Streams.size();
    if (all > lines.size())
        lines.push_back("and " + std::to_string(all - lines.size()) + " more");
    return lines;
}
}  // namespace

std::vector<TableLine> RadioTableLines(const RadioUse &use, double fleetAgeS, std::size_t columns)
{
    std::vector<TableLine> lines;
    if (!use.Known)
        return lines;
    const std::vector<std::string> held = HeldByName(use);
    const bool warn = !held.empty() || fleetAgeS > FleetFreshS;
    lines.push_back({"Radio: " + Summary(use, fleetAgeS), warn ? Emphasis::Warning : Emphasis::None});
    if (use.IsLimited())
        for (std::string &line : WrappedLines("  kB/s:", Classes(use.Air), columns))
            lines.push_back({std::move(line)});
    for (const std::string &line : held)
        lines.push_back({"  " + line});
    return lines;
}

std::string RadioLogLine(const RadioUse &use, double fleetAgeS, double elapsedS)
{
    if (!use.Known)
        return "";
    std::string line = Format("%7.1f s  ", elapsedS) + "radio " + Summary(use, fleetAgeS);
    if (use.IsLimited())
        for (const std::string &classes : WrappedLines("; kB/s:", Classes(use.Air), std::string::npos))
            line += classes;
    for (const std::string &held : HeldByName(use))
        line += "; " + held;
    return line;
}

}  // namespace Ground
