#pragma once

#include <rabit/RabitManager.h>
#include <rabit/RabitWorkspace.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// Running managers again with what they read in flight: to see what a manager did and why, in a debugger if
// need be, and whether one that was changed does the same.
//
// A node records the steps of the managers that its configuration names (`record: steps: [MissionControl]`):
// of each Startup, unit of work and Shutdown, in the manager's own order, every reading of the clock, every
// message that a fetch brought, every message that it took from a queue, whether queues took what it added,
// and the messages that it posted and added. The manager runs again alone, in a RabitSteppedReactor and a
// workspace of its own: the same steps, whenever they ran, each of them reading the same; so neither the
// order of threads nor the time that anything took matters. What it posts and adds to queues is compared with
// what it posted and added then, byte for byte.
//
// It is exact for a manager that is a function of what it reads through Rabit. It needs for that:
// - The recording of the manager's Startup and of all steps since. A black box, or a recording whose oldest
//   files were removed, has none. Steps that were lost end the rerun there; it says so.
// - The same constructor arguments, and a constructor that reads nothing: no clock, no messages.
// - Time from the clock of its workspace, which is the system's or a ManualClock: directly, as an age of a
//   message (GetAgeSeconds), or as the stamp of a post. Not from std::chrono, SystemTimeClock or time stamps
//   of messages that were made and not posted.
// - Messages of types made from IDL. What others are fetched or taken is a problem that is told, with its
//   name; of others that are posted, only the name is compared. The three ints of a RabitMessage are not
//   recorded.
// - Queues of RabitMessages that call themselves what they are registered as, as a manager's own queue does.
//   How full a queue is, is not recorded: a manager that takes messages until there are no more is exact.
// - Receipts are told at once whether the queue took the message, and nothing afterwards.
// - No random numbers that differ from run to run, no threads, files, sockets or devices of its own, no order
//   that follows from addresses, and no variables that it shares with other managers. A manager that reads
//   what a device says is best split into one that reads and one that decides.
// - The same types, compiler and libraries where numbers must agree to the last bit.
namespace Rabit
{
namespace Rerun
{
struct ManagerStep;
}

// One life of a manager, as it was recorded. May be copied and shared.
class ManagerRecording
{
public:
    // All lives of the managers of that name in the files of one node, which may be given in any order, or in
    // a merged file; an empty node: of any. Several nodes: each has its own. Empty if there is none, then
    // `problems` says why; what cannot be read is told there as well, one line each.
    static std::vector<ManagerRecording> Read(const std::vector<std::string> &files,
                                              const std::string &manager, const std::string &node,
                                              std::vector<std::string> &problems);

    const std::string &Node() const { return _node; }
    const std::string &Manager() const { return _manager; }
    // Its Startup included.
    std::size_t NumberOfSteps() const;
    // Why its steps end where they do although more were recorded, or cannot be run; empty: they are whole.
    const std::string &Problem() const { return _problem; }

private:
    friend class ManagerRerun;
    std::string _node;
    std::string _manager;
    std::string _problem;
    std::shared_ptr<const std::vector<Rerun::ManagerStep>> _steps;
};

// The first thing that a manager did otherwise than it was recorded.
struct RerunDifference
{
    std::uint64_t Step = 0;     // 0 is its Startup
    double SinceStartupS = 0;   // when that step began
    std::uint64_t LogTime = 0;  // the same moment, as the recording has it: UTC, nanoseconds since 1970
    // "message MissionState", "Uav::Course for queue Autopilot", "the end of the step".
    std::string What;
    std::string Field;     // such as `items[2].stage`; empty: all of it
    std::string Recorded;  // as JSON; or "nothing", or what else there was instead
    std::string Computed;

    // One line for people.
    std::string ToString() const;
};

struct RerunResult
{
    // Why it did not run, or not to the end; empty: it did.
    std::string Problem;
    std::uint64_t Steps = 0;    // that ran
    std::uint64_t Outputs = 0;  // posts and messages for queues that were compared
    std::uint64_t Digest = 0;   // of all that it posted and added; the same for runs that are alike
    std::optional<RerunDifference> Difference;

    bool IsAlike() const { return Problem.empty() && !Difference; }
};

// Runs managers again. Stops at the first difference.
class ManagerRerun
{
public:
    // Makes the manager, of the same name and arguments as then, in that workspace.
    using MakeManager = std::function<std::unique_ptr<RabitManager>(RabitWorkspace &workspace)>;
    static RerunResult Run(const ManagerRecording &recording, const MakeManager &make);
};

}  // namespace Rabit
