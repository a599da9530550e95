#include "Usage.h"

#include <sys/resource.h>
#include <time.h>

#include <sstream>

namespace Rabit::Bench
{
namespace
{

constexpr std::int64_t Second = 1000000000;

std::int64_t Nanoseconds(const timeval &time)
{
    return time.tv_sec * Second + time.tv_usec * std::int64_t{1000};
}

}  // namespace

std::int64_t Now()
{
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * Second + now.tv_nsec;
}

Usage Usage::Take()
{
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return {Nanoseconds(used.ru_utime) + Nanoseconds(used.ru_stime), AllocationsSoFar(), used.ru_nvcsw};
}

std::string PerMessage(const Usage &before, const Usage &after, std::uint64_t messages)
{
    const auto count = static_cast<double>(messages);
    std::ostringstream out;
    out << "\"cpu_ns\": " << static_cast<double>(after.Processor - before.Processor) / count
        << ", \"allocations\": " << static_cast<double>(after.Allocations - before.Allocations) / count
        << ", \"sleeps\": " << static_cast<double>(after.Switches - before.Switches) / count;
    return out.str();
}

}  // namespace Rabit::Bench
