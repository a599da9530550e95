#include "Verdict.h"

#include "NumberText.h"

#include <algorithm>

namespace Ground
{
namespace
{
std::string OneDecimal(double value)
{
    return Format("%.1f", value);
}

std::string Percent(const AircraftResult &result)
{
    if (result.Published == 0)
        return "-";
    return OneDecimal(100.0 * static_cast<double>(result.Heard) / static_cast<double>(result.Published)) +
           " %";
}

bool HeardEnough(const AircraftResult &result)
{
    return static_cast<double>(result.Heard) >= RequiredShare * static_cast<double>(result.Published);
}

std::string SummaryLine(const AircraftResult &result)
{
    const CommandLog::Tally &commands = result.Commands;
    std::string line = "  " + result.Node + "  " + ToText(result.State) + "  heard " +
                       std::to_string(result.Heard) + " of " + std::to_string(result.Published) + " poses (" +
                       Percent(result) + "), commands " + std::to_string(commands.Sent) + " sent " +
                       std::to_string(commands.Acknowledged) + " acknowledged";
    if (commands.Declined > 0)
        line += ", " + std::to_string(commands.Declined) + " declined";
    if (commands.Refused > 0)
        line += ", " + std::to_string(commands.Refused) + " refused for sending";
    return line;
}

void JudgeAircraft(const AircraftResult &result, const Demands &demands, std::vector<std::string> &failures)
{
    if (result.State != RowState::Up)
        failures.push_back(result.Node + " was " + ToText(result.State) + " at the end");
    if (result.Published == 0)
        failures.push_back(result.Node + ": no poses to judge, it was not heard for long enough");
    else if (!HeardEnough(result))
        failures.push_back(result.Node + ": only " + Percent(result) + " of its poses were heard, not " +
                           OneDecimal(100 * RequiredShare) + " %");
    if (result.Commands.Sent == 0 && demands.Commanded.contains(result.Node))
        failures.push_back(result.Node + ": no command was sent to it");
}

bool AnyTracked(const std::vector<AircraftResult> &aircraft)
{
    return std::any_of(aircraft.begin(), aircraft.end(),
                       [](const AircraftResult &result)
                       { return std::any_of(result.Targets.begin(), result.Targets.end(), IsTracked); });
}
}  // namespace

Verdict Judge(const std::vector<AircraftResult> &aircraft, const CommandLog &commands, const Demands &demands,
              double elapsedS)
{
    Verdict verdict;
    std::vector<std::string> &failures = verdict.Failures;
    if (aircraft.empty())
        failures.push_back("no aircraft was heard");
    for (const AircraftResult &result : aircraft)
        JudgeAircraft(result, demands, failures);
    for (const CommandStatus &command : commands.Outstanding())
        failures.push_back("command " + std::to_string(command.number) + " to " + command.node +
                           ", sent at " + OneDecimal(command.sent_s) + " s, was not acknowledged");
    if (commands.WrongNode() > 0)
        failures.push_back(std::to_string(commands.WrongNode()) +
                           " acknowledgements came from the wrong aircraft");
    if (commands.Repeated() > 0)
        failures.push_back(std::to_string(commands.Repeated()) + " acknowledgements came more than once");

    if (demands.TrackedTarget && !AnyTracked(aircraft))
        failures.push_back("no target was found by one aircraft, validated by another, and followed");

    verdict.Summary.push_back("Summary after " + OneDecimal(elapsedS) + " s");
    for (const AircraftResult &result : aircraft)
        verdict.Summary.push_back(SummaryLine(result));
    for (const AircraftResult &result : aircraft)
        for (const FoundTarget &target : result.Targets)
            verdict.Summary.push_back("  " + TargetLine(target));
    if (commands.Unknown() > 0)
        verdict.Summary.push_back("  " + std::to_string(commands.Unknown()) +
                                  " acknowledgements of commands that this ground station did not send");
    for (const std::string &failure : failures)
        verdict.Summary.push_back("  FAILED: " + failure);
    verdict.Summary.push_back(verdict.Passed() ? "Passed" : "Failed");
    return verdict;
}

}  // namespace Ground
