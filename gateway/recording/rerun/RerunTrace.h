#pragma once

#include <rabit/RabitManagerTrace.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/recording/ManagerRerun.h>

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "recording/rerun/ManagerStep.h"
#include "recording/rerun/MessageNames.h"

namespace Rabit::Rerun
{

// Gives a manager the inputs of a recorded step again, and compares its outputs.
class RerunTrace final : public RabitManagerTrace
{
public:
    RerunTrace(RabitWorkspace &workspace, RerunResult &result)
        : _workspace(workspace), _result(result), _names(workspace)
    {
    }

    // Prepares the step that runs next: brings the messages that it reads into the workspace. Null: what
    // runs is ignored.
    void Prepare(const ManagerStep *step, double sinceStartupS);

    void BeginStep(Step step, bool isTurn) override;
    void EndStep(bool threw) override;
    void ReadMonotonic(std::chrono::nanoseconds &time) override;
    void ReadGpsTime(double &gpsTimeSeconds) override;
    void Fetched(const PublishSubscribeMessage &global, const RabitMessage &message,
                 std::uint64_t number) override;
    std::optional<PostTime> Posting(const PublishSubscribeMessage &global) override;
    void Posted(const PublishSubscribeMessage &global, const RabitMessage &message,
                std::uint64_t number) override;
    void Taken(const std::string &queue, const RabitMessage &message) override;
    std::optional<bool> Adding(const std::string &queue, const RabitMessage &message) override;
    void Added(bool) override {}
    void Listed(std::vector<MessageInfo> &messages) override;

private:
    using Events = std::deque<const StepEvent *>;

    std::shared_ptr<RabitMessage> MessageOf(const StepEvent &event);
    bool Register(const std::string &name, const std::string &type);
    void Bring(const std::string &name);
    void Passed(const std::string &name, StepEvent::Kind what);
    void BringToQueue();
    // Takes out the next event; null if there is none.
    static const StepEvent *Next(Events &events);
    void Compare(const StepEvent *recorded, StepEvent::Kind what, const std::string &name,
                 const RabitMessage &message);
    void Differs(const std::string &what, const std::string &field, const std::string &recorded,
                 const std::string &computed);
    void Problem(const std::string &text);

    RabitWorkspace &_workspace;
    RerunResult &_result;
    MessageNames _names;

    const ManagerStep *_step = nullptr;
    bool _runs = false;  // true while _step runs
    double _sinceStartupS = 0;
    std::chrono::nanoseconds _monotonic{0};  // the last readings
    double _gpsTime = 0;
    // The inputs and outputs of the step that are still to come.
    Events _monotonicReadings;
    Events _gpsReadings;
    Events _outputs;
    Events _lists;
    std::deque<std::pair<std::string, std::shared_ptr<RabitMessage>>> _forQueues;
    std::map<std::string, Events> _posts;           // fetches and posts of each message, in their order
    std::map<std::string, std::uint64_t> _brought;  // the post that each message holds
    std::set<std::string> _known;                   // messages that were listed
};

}  // namespace Rabit::Rerun
