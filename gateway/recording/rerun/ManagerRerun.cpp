#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/base/Fnv1a.h>
#include <rabit/recording/ManagerRerun.h>

#include <cstdio>
#include <utility>

#include "recording/rerun/RerunTrace.h"

namespace Rabit
{
namespace
{

using Rerun::ManagerStep;
using Step = RabitManagerTrace::Step;

// One manager in a workspace of its own.
class Stage
{
public:
    Stage(const ManagerRecording &recording, const std::vector<ManagerStep> &steps, RerunResult &result)
        : _recording(recording),
          _steps(steps),
          _result(result),
          _clock(std::make_shared<ManualClock>(steps.front().BeganGpsTime, steps.front().Began)),
          _workspace(_clock),
          _trace(std::make_shared<Rerun::RerunTrace>(_workspace, result)),
          _reactor(_workspace)
    {
        _workspace.SetManagerTracing([this](const std::string &manager)
                                     { return manager == _recording.Manager() ? _trace : nullptr; });
    }

    void Run(const ManagerRerun::MakeManager &make)
    {
        std::unique_ptr<RabitManager> manager = make(_workspace);
        if (!manager || manager->GetManagerName() != _recording.Manager())
        {
            _result.Problem = "the manager that was made is not called " + _recording.Manager();
            return;
        }
        const RabitManager &theManager = *manager;
        _reactor.AddManager(std::move(manager));
        for (const ManagerStep &step : _steps)
        {
            const std::uint64_t before = _result.Steps;
            Prepare(step);
            Go(theManager, step);
            if (_result.Steps == before && !_result.Difference && _result.Problem.empty())
            {
                _result.Problem =
                    "step " + std::to_string(step.Number) + " did not run: the manager had ended";
            }
            const bool isEnd = step.What == Step::Startup && step.Threw;  // its Shutdown came with it
            if (isEnd || _result.Difference || !_result.Problem.empty())
            {
                break;
            }
        }
        _trace->Prepare(nullptr, 0);
    }

private:
    void Prepare(const ManagerStep &step)
    {
        _clock->AdvanceTo(step.Began);
        _clock->SetGpsTimeSeconds(step.BeganGpsTime);
        _trace->Prepare(&step, std::chrono::duration<double>(step.Began - _steps.front().Began).count());
    }

    void Go(const RabitManager &manager, const ManagerStep &step)
    {
        switch (step.What)
        {
            case Step::Startup:
                _reactor.Start();
                break;
            case Step::UnitOfWork:
                _reactor.RunPassOf(manager, step.IsTurn);
                break;
            case Step::Shutdown:
                _reactor.Stop();
                break;
        }
    }

    const ManagerRecording &_recording;
    const std::vector<ManagerStep> &_steps;
    RerunResult &_result;
    const std::shared_ptr<ManualClock> _clock;
    RabitWorkspace _workspace;
    const std::shared_ptr<Rerun::RerunTrace> _trace;
    RabitSteppedReactor _reactor;
};

}  // namespace

RerunResult ManagerRerun::Run(const ManagerRecording &recording, const MakeManager &make)
{
    RerunResult result;
    result.Digest = Fnv1a().Sum();
    const std::vector<ManagerStep> &steps = *recording._steps;
    if (!steps.empty())
    {
        Stage(recording, steps, result).Run(make);
    }
    if (result.Problem.empty() && !result.Difference)
    {
        result.Problem = recording.Problem();
    }
    return result;
}

std::string RerunDifference::ToString() const
{
    char when[64];
    std::snprintf(when, sizeof when,
                  "step %llu, %.3f s after its startup: ", static_cast<unsigned long long>(Step),
                  SinceStartupS);
    return when + What + (Field.empty() ? "" : ", " + Field) + ": recorded " + Recorded + ", now " + Computed;
}

}  // namespace Rabit
