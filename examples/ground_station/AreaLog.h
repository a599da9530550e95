#pragma once

#include "ground.idl.h"
#include "uav.idl.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace Ground
{

// The report of one aircraft on its search area: of its last MissionState.
struct AreaReport
{
    std::string Node;
    bool IsLost = false;
    std::uint32_t InForce = 0;  // number of the area in force there; 0: none
    std::string Declined;       // why the last area that it heard is not in force; empty if it is
    double AtS = 0;             // when the aircraft reported, in seconds since the ground station's start
};

// Records each search area that this ground station published, and its outcome at each aircraft.
//
// A report has no number for the area that the aircraft declines. The reason belongs to the wanted area in
// two cases: it differs from the reason before that area, or the report was made HeardAfterS after the area.
// Not thread-safe.
class AreaLog
{
public:
    // The last areas are listed, this many at most.
    static constexpr std::size_t MaxListed = 10;
    // An aircraft that reports so long after an area was published has heard it: the ground station repeats
    // the area each second, and the aircraft its report.
    static constexpr double HeardAfterS = 3;

    void Given(const Uav::SearchArea &area, double nowS);
    // Replaces all answers. In the order in which they should be listed.
    void Look(const std::vector<AreaReport> &reports);

    // Oldest first; the last one is the wanted area.
    const std::vector<AreaStatus> &Areas() const { return _areas; }

private:
    AreaAnswer AnswerOf(const AreaReport &report, const AreaStatus &area) const;

    std::vector<AreaStatus> _areas;
    std::vector<AreaReport> _reports;            // the last ones
    std::map<std::string, std::string> _before;  // by node: why it declined an area before the wanted one
};

}  // namespace Ground
