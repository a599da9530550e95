#pragma once

#include <cstdint>
#include <string>

namespace Rabit
{

// Counters and durations that a manager measures of its own loop. All times in seconds.
struct ManagerStats_t
{
    int TotalNumberOfExecuteCycles = 0;  // since the manager was made; never cleared
    int NumberOfExecuteCycles = 0;
    double TimeSinceLastStatsReset_Sec = 0.0;
    double MinExecuteUnitOfWorkTime_Sec = 0.0;
    double MaxExecuteUnitOfWorkTime_Sec = 0.0;
    double AveExecuteUnitOfWorkTime_Sec = 0.0;
    double TotalExecuteUnitOfWorkTime_Sec = 0.0;
    double MinSleepTime_Sec = 0.0;
    double MaxSleepTime_Sec = 0.0;
    double AveSleepTime_Sec = 0.0;
    double TotalSleepTime_Sec = 0.0;
    int NumberOfWakeUpCallsWhileAsleep = 0;
    int NumberOfWakeUpCallsWhileAwake = 0;

    // Numbers of measurements behind the minima, maxima and averages.
    int NumberOfExecuteTimes = 0;
    int NumberOfSleepTimes = 0;
    // Turns of the manager's period that passed without a unit of work of their own.
    std::uint64_t NumberOfMissedTurns = 0;

    // Zeroes everything but TotalNumberOfExecuteCycles.
    void Clear();
    void UpdateExeUnitOfWorkTimeStats(double executeTime_Sec);
    void UpdateSleepTimeStats(double sleepTime_Sec);
    std::string ToString() const;
};

}  // namespace Rabit
