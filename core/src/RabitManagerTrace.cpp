#include <rabit/RabitManagerTrace.h>

namespace Rabit
{
namespace
{

thread_local RabitManagerTrace *current = nullptr;

}  // namespace

RabitManagerTrace *RabitManagerTrace::Current() noexcept
{
    return current;
}

RabitManagerTrace::Pause::Pause() noexcept : _trace(std::exchange(current, nullptr)) {}

RabitManagerTrace::Pause::~Pause()
{
    current = _trace;
}

RabitManagerTrace::Scope::Scope(const std::shared_ptr<RabitManagerTrace> &trace, Step step, bool isTurn)
    : _trace(trace), _former(std::exchange(current, nullptr))
{
    if (_trace)
    {
        _trace->BeginStep(step, isTurn);
    }
    current = _trace.get();
}

RabitManagerTrace::Scope::~Scope()
{
    current = nullptr;
    if (_trace)
    {
        _trace->EndStep(_threw);
    }
    current = _former;
}

}  // namespace Rabit
