#pragma once

#include "CommandLog.h"
#include "FleetTable.h"
#include "TargetLines.h"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace Ground
{

// The results of a run for one aircraft.
struct AircraftResult
{
    std::string Node;
    RowState State = RowState::Waiting;  // at the end
    std::uint64_t Published = 0;         // poses, as PoseCount says
    std::uint64_t Heard = 0;
    CommandLog::Tally Commands;
    std::vector<FoundTarget> Targets;
};

// Demands on a run besides those on every run.
struct Demands
{
    std::set<std::string> Commanded{};  // these aircraft must have been sent a command
    bool TrackedTarget = false;         // a target found by one aircraft, validated by another, and followed
};

// A run passes under four conditions. Every aircraft is UP at its end. At least 90 % of the poses that each
// published were heard. Every command was acknowledged once by the aircraft it was meant for, or certainly
// never arrived. The demands are met.
struct Verdict
{
    std::vector<std::string> Failures;  // one line for each failure
    std::vector<std::string> Summary;   // for people: aircraft, outstanding commands, failures, result

    bool Passed() const { return Failures.empty(); }
};

inline constexpr double RequiredShare = 0.9;

Verdict Judge(const std::vector<AircraftResult> &aircraft, const CommandLog &commands, const Demands &demands,
              double elapsedS);

}  // namespace Ground
