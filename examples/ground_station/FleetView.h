#pragma once

#include "AircraftMonitor.h"
#include "FleetTable.h"
#include "NodeState.h"
#include "RadioWatch.h"
#include "TargetLines.h"
#include "TerminalScreen.h"
#include "ground.idl.h"

#include <rabit/RabitManager.h>
#include <rabit/gateway/Fleet.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace Ground
{

// Shows the fleet on the standard output: the manager `FleetView`. On a terminal it redraws a table in
// place, otherwise it writes a line a second for each aircraft. Below follow other problems of the
// aircraft, the state of the radio, and current problems of the data flow.
//
// Fetches: Gateway/Fleet, from which it learns the nodes; <node>/Pose, <node>/MissionState, <node>/Findings
// and <node>.vision/Targets of each of them; and CommandTally, CommandList and AreaList of the Commander.
//
// A node counts as an aircraft once a pose or mission state of it has come, or if it is expected.
class FleetView : public Rabit::RabitManager
{
public:
    static constexpr std::chrono::milliseconds ScreenPeriod{200};
    static constexpr std::chrono::milliseconds LogPeriod{1000};

    struct Settings
    {
        std::vector<std::string> Expected;  // names of aircraft
        RateLimits MaxRates{};              // of this node's configuration
    };

    // The output. The stream must outlive the manager, and no other code may write to it while the manager
    // runs.
    struct Output
    {
        std::ostream &Stream;
        bool IsTerminal = false;  // the standard output is one
        // If set and the output is a terminal: returns lines to write once, above the table.
        std::function<std::vector<std::string>()> TakeLog{};
    };

    // Results of one aircraft, for the summary at the end.
    struct Seen
    {
        FleetRow Row;
        std::uint64_t Published = 0;
        std::uint64_t Heard = 0;
        std::vector<FoundTarget> Targets;  // each is listed once, at the aircraft that got farthest with it
    };

    FleetView(const Settings &settings, Output output,
              Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());

    void Startup() final;
    void ExecuteUnitOfWork() final;

    // As of the last unit of work. Call it when the reactor's Run has returned.
    const std::vector<Seen> &Result() const { return _seen; }

private:
    struct Aircraft
    {
        std::unique_ptr<AircraftMonitor> Monitor;
        bool Expected = false;
    };

    // The stage of a target, and the number of its other names.
    using Shown = std::pair<Uav::TargetStage, std::size_t>;

    void Look();
    void FollowNewNodes();
    void Print();
    void PrintTable(const std::vector<FleetRow> &rows, double elapsedS);
    void PrintLog(const std::vector<FleetRow> &rows, double elapsedS);
    std::vector<std::string> TargetLinesThatChanged();
    std::vector<std::string> Attention(const std::vector<FleetRow> &rows) const;
    std::string NewAreaLine();
    std::vector<std::string> NewAttention(const std::vector<FleetRow> &rows);

    const Output _output;
    std::chrono::nanoseconds _start{0};
    std::map<std::string, Aircraft, NaturalOrder> _aircraft;
    std::vector<Seen> _seen;
    std::map<std::string, Shown> _shownTargets;  // by name
    std::set<std::string> _shownAttention;
    std::string _shownArea;
    TerminalScreen _screen;
    RadioWatch _radio;
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<CommandTally> _tally = std::make_shared<CommandTally>();
    std::shared_ptr<CommandList> _commands = std::make_shared<CommandList>();
    std::shared_ptr<AreaList> _areas = std::make_shared<AreaList>();
};

}  // namespace Ground
