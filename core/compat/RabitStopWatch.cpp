#include <rabit/RabitStopWatch.h>

namespace Rabit
{

RabitStopWatch::RabitStopWatch()
{
    reset();
}

void RabitStopWatch::tick()
{
    _older = _newer;
    captureTime();
}

void RabitStopWatch::reset()
{
    captureTime();
    _older = _newer;
}

void RabitStopWatch::start()
{
    reset();
}

void RabitStopWatch::stop()
{
    captureTime();
}

void RabitStopWatch::captureTime()
{
    _newer = std::chrono::steady_clock::now();
}

double RabitStopWatch::getTimeElapsed() const
{
    return static_cast<double>(std::chrono::duration<float>(_newer - _older).count());
}

}  // namespace Rabit
