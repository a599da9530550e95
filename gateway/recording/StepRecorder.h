#pragma once

#include <rabit/RabitManagerTrace.h>
#include <rabit/RabitWorkspace.h>

#include <map>
#include <memory>
#include <set>
#include <string>

#include "recording/RecordingTarget.h"
#include "recording/rerun/ManagerStep.h"
#include "recording/rerun/MessageNames.h"

namespace Rabit
{

// Records the steps of one manager, with all that they read and did, so that they can run again. Each step
// is one message, and needs no other stream.
class StepRecorder final : public RabitManagerTrace
{
public:
    StepRecorder(const std::string &manager, const RabitWorkspace &workspace,
                 std::shared_ptr<RecordingTarget> target);

    void BeginStep(Step step, bool isTurn) override;
    void EndStep(bool threw) override;
    void ReadMonotonic(std::chrono::nanoseconds &time) override;
    void ReadGpsTime(double &gpsTimeSeconds) override;
    void Fetched(const PublishSubscribeMessage &global, const RabitMessage &message,
                 std::uint64_t number) override;
    std::optional<PostTime> Posting(const PublishSubscribeMessage &) override { return std::nullopt; }
    void Posted(const PublishSubscribeMessage &global, const RabitMessage &message,
                std::uint64_t number) override;
    void Taken(const std::string &queue, const RabitMessage &message) override;
    std::optional<bool> Adding(const std::string &queue, const RabitMessage &message) override;
    void Added(bool accepted) override;
    void Listed(std::vector<MessageInfo> &messages) override;

private:
    Rerun::StepEvent &Add(Rerun::StepEvent::Kind what);
    Rerun::StepEvent &Add(Rerun::StepEvent::Kind what, const std::string &name, const RabitMessage &message,
                          bool withSample);

    const RabitWorkspace &_workspace;
    const std::shared_ptr<RecordingTarget> _target;
    const std::uint32_t _stream;
    Rerun::MessageNames _names;
    std::map<std::string, std::uint64_t> _fetched;  // the post of each message whose sample was recorded last
    std::set<std::string> _listed;
    Rerun::ManagerStep _step;
    std::uint64_t _next = 0;
};

}  // namespace Rabit
