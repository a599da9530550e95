#pragma once

#include "StationData.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace Ground
{

// An event.
struct StationEvent
{
    enum class Weight
    {
        Info,
        Warning,
        Alarm
    };

    std::uint64_t Number = 0;  // counted from 1
    double AtS = 0;            // StationData::NowS then
    Weight How = Weight::Info;
    std::string Node;  // the aircraft concerned; may be empty
    std::string Text;
};

// Finds events by comparing the present data with the previous data. Bounded. Not thread-safe.
class EventLog
{
public:
    static constexpr std::size_t MaxEvents = 200;
    // Maximum number of commands, of targets and of problems that are followed; others are ignored.
    static constexpr std::size_t MaxFollowed = 2000;
    // A problem is an event once it has lasted for this long. By then, the texts of other nodes' problems
    // have come.
    static constexpr double ProblemLastsS = 5;
    // The outcome of a search area is an event once all aircraft have answered, or after this time.
    static constexpr double AreaAnswersS = 5;
    // An aircraft has good positions again once no bad one has come for this time.
    static constexpr double PositionHoldsS = 5;

    void Look(const StationData &now);

    // Oldest first.
    const std::deque<StationEvent> &Events() const { return _events; }

private:
    using Weight = StationEvent::Weight;

    struct Known
    {
        std::optional<RowState> State;
        std::optional<Uav::MissionMode> Mode;
        bool WantsHome = false;
        std::string HomeReason;
        bool WithoutOrders = false;
        std::string AreaDeclined;
        std::optional<double> BadAtS;  // when its position was bad last; none: it has good ones again
    };

    void LookAtAircraft(const AircraftData &aircraft);
    void LookAtTargets(const StationData &now);
    void LookAtPosition(const AircraftData &aircraft, Known &known);
    void LookAtArea(const AreaStatus &area);
    void LookAtCommands(const CommandList &list);
    void LookAtProblems(const StationData &now);
    void Add(Weight weight, const std::string &node, const std::string &text);

    double _nowS = 0;
    std::uint64_t _number = 0;
    std::deque<StationEvent> _events;
    std::map<std::string, Known> _aircraft;
    std::map<std::string, Uav::TargetStage> _targets;  // by name
    std::map<std::uint32_t, std::size_t> _commands;    // by id: how many of its steps were told
    struct KnownProblem
    {
        double SinceS = 0;
        bool Told = false;
    };
    std::map<std::string, KnownProblem> _problems;  // by node and text
    std::uint32_t _area = 0;                        // number of the wanted one
    double _areaSinceS = 0;
    std::string _areaText;  // the last one that was told
};

}  // namespace Ground
