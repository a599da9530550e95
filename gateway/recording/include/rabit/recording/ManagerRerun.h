#pragma once

#include <rabit/RabitManager.h>
#include <rabit/RabitWorkspace.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// Runs managers again with what they read in flight. That shows what a manager did and why, in a debugger
// if need be, and whether a changed manager does the same.
//
// A node records the steps of the managers that are named in its configuration (`record: steps:`). A step
// is one Startup, unit of work or Shutdown. It holds every reading of the clock, and every message that a
// fetch brought or that was taken from a queue. It also holds whether queues accepted what the manager added,
// and the messages that it posted and added. All are in the manager's own order. The manager runs again
// alone, in a RabitSteppedReactor and a workspace of its own: the same steps, with the same readings. So
// neither the order of threads nor the time that anything took matters. The messages that it posts and adds
// to queues are compared with the recorded ones, byte for byte.
//
// A rerun is exact for a manager that is a function of what it reads through Rabit. It needs:
// - The recording of the manager's Startup and of all steps since. A black box, or a recording whose oldest
//   files were removed, lacks these. Lost steps end the rerun at that point, and its result says so.
// - The same constructor arguments, and a constructor that reads nothing: no clock, no messages.
// - Time from the clock of its workspace, which is the system's or a ManualClock: directly, as an age of a
//   message (GetAgeSeconds), or as the stamp of a post. Not from std::chrono, SystemTimeClock or time stamps
//   of messages that were made and not posted.
// - Messages of types made from IDL. A message of another type that is fetched or taken is a problem, which
//   the result names. Of a posted message of another type only the name is compared. The three ints of a
//   RabitMessage are not recorded.
// - Queues of RabitMessages that have the name under which they are registered, as a manager's own queue
//   has. The fill of a queue is not recorded: a manager that takes messages until there are no more is
//   exact.
// - No later outcomes of receipts: a rerun tells a receipt at once whether the queue accepted the message,
//   and nothing afterwards.
// - No random numbers that differ from run to run, and no order that follows from addresses. No threads,
//   files, sockets or devices of its own, and no variables that it shares with other managers. A manager that
//   reads a device is best split into one that reads and one that decides.
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
    // Returns all lives of the managers of that name on that node; an empty `node` means any, and each node
    // has lives of its own. `files` are the files of a recording, in any order, or a merged file. If there
    // is no life, `problems` says why. It also names the parts that cannot be read, one line each.
    static std::vector<ManagerRecording> Read(const std::vector<std::string> &files,
                                              const std::string &manager, const std::string &node,
                                              std::vector<std::string> &problems);

    const std::string &Node() const { return _node; }
    const std::string &Manager() const { return _manager; }
    // The Startup included.
    std::size_t NumberOfSteps() const;
    // Why the steps end although more were recorded, or cannot be run; empty if they are complete.
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
    // Why it did not run, or not to the end, apart from a difference; empty if there is no such reason.
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
    // Makes the manager in that workspace, with its recorded name and the arguments that it had in flight.
    using MakeManager = std::function<std::unique_ptr<RabitManager>(RabitWorkspace &workspace)>;
    static RerunResult Run(const ManagerRecording &recording, const MakeManager &make);
};

}  // namespace Rabit
