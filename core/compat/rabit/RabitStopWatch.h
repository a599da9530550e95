#pragma once

#include <chrono>

namespace Rabit
{

// Measures the time between two captures by the steady clock. Not thread-safe.
class RabitStopWatch
{
public:
    // Both captures are now.
    RabitStopWatch();

    // The newer capture becomes the older one and now the newer.
    void tick();
    // Both captures become now: nothing has elapsed.
    void reset();
    // The same as reset, under the name that goes with stop.
    void start();
    // The newer capture becomes now.
    void stop();
    void captureTime();
    // From the older to the newer capture, in seconds, with the precision of a float.
    double getTimeElapsed() const;

private:
    std::chrono::steady_clock::time_point _older;
    std::chrono::steady_clock::time_point _newer;
};

}  // namespace Rabit
