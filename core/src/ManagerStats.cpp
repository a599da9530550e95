#include <rabit/ManagerStats.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace Rabit
{
namespace
{

void Update(double time, int &count, double &minimum, double &maximum, double &average, double &total)
{
    count = std::min(count, std::numeric_limits<int>::max() - 1) + 1;
    minimum = (count == 1) ? time : std::min(minimum, time);
    maximum = (count == 1) ? time : std::max(maximum, time);
    total += time;
    average = total / count;
}

}  // namespace

void ManagerStats_t::Clear()
{
    const int total = TotalNumberOfExecuteCycles;
    *this = ManagerStats_t();
    TotalNumberOfExecuteCycles = total;
}

void ManagerStats_t::UpdateExeUnitOfWorkTimeStats(double executeTime_Sec)
{
    Update(executeTime_Sec, NumberOfExecuteTimes, MinExecuteUnitOfWorkTime_Sec, MaxExecuteUnitOfWorkTime_Sec,
           AveExecuteUnitOfWorkTime_Sec, TotalExecuteUnitOfWorkTime_Sec);
}

void ManagerStats_t::UpdateSleepTimeStats(double sleepTime_Sec)
{
    Update(sleepTime_Sec, NumberOfSleepTimes, MinSleepTime_Sec, MaxSleepTime_Sec, AveSleepTime_Sec,
           TotalSleepTime_Sec);
}

std::string ManagerStats_t::ToString() const
{
    std::ostringstream text;
    text << "Cycles: " << NumberOfExecuteCycles << " (total " << TotalNumberOfExecuteCycles << ") in "
         << TimeSinceLastStatsReset_Sec << " s\n"
         << "Unit of work [s]: min " << MinExecuteUnitOfWorkTime_Sec << " max "
         << MaxExecuteUnitOfWorkTime_Sec << " ave " << AveExecuteUnitOfWorkTime_Sec << " total "
         << TotalExecuteUnitOfWorkTime_Sec << "\n"
         << "Sleep [s]: min " << MinSleepTime_Sec << " max " << MaxSleepTime_Sec << " ave "
         << AveSleepTime_Sec << " total " << TotalSleepTime_Sec << "\n"
         << "Wake-up calls: " << NumberOfWakeUpCallsWhileAsleep << " asleep, "
         << NumberOfWakeUpCallsWhileAwake << " awake\n"
         << "Missed turns: " << NumberOfMissedTurns << "\n";
    return text.str();
}

}  // namespace Rabit
