#include "AimsTable.h"

#include <algorithm>
#include <cstdio>

namespace
{

struct Row
{
    std::string What;
    std::string AimText;
    double Measured;
    double Aim;
    const char *Unit;
};

// True if threads or sleep are measured: these are judged by real time. Processor time, used elsewhere,
// leaves out other programs.
bool IsRealTime(const std::string &name)
{
    return name.find("/real_time") != std::string::npos || name.find("/manual_time") != std::string::npos;
}

// The member is called otherwise from version 1.8 of the library on.
template <class Run>
bool HasFailed(const Run &run)
{
    if constexpr (requires { run.error_occurred; })
    {
        return run.error_occurred;
    }
    else
    {
        return run.skipped != decltype(run.skipped){};
    }
}

// Returns the name without the suffixes that the library adds.
std::string BaseName(const std::string &name)
{
    std::string base = name;
    for (const char *addition : {"/real_time", "/manual_time", "/iterations:1", "/iterations:5"})
    {
        const std::size_t at = base.find(addition);
        if (at != std::string::npos)
        {
            base.erase(at, std::string(addition).size());
        }
    }
    return base;
}

}  // namespace

void AimsTable::ReportRuns(const std::vector<Run> &runs)
{
    ConsoleReporter::ReportRuns(runs);
    for (const Run &run : runs)
    {
        if (run.run_type != Run::RT_Iteration || HasFailed(run))
        {
            continue;
        }
        const std::string name = run.benchmark_name();
        const double unit = benchmark::GetTimeUnitMultiplier(run.time_unit);
        const double time =
            1e9 / unit * (IsRealTime(name) ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime());
        const auto inserted = _results.emplace(BaseName(name), Result{time, {}});
        Result &best = inserted.first->second;
        best.Nanoseconds = std::min(best.Nanoseconds, time);
        for (const auto &counter : run.counters)
        {
            const auto known = best.Counters.emplace(counter.first, counter.second.value);
            known.first->second = counter.first == "wrong"
                                      ? std::max(known.first->second, counter.second.value)
                                      : std::min(known.first->second, counter.second.value);
        }
    }
}

double AimsTable::Time(const std::string &name) const
{
    const auto found = _results.find(name);
    return found == _results.end() ? 0.0 : found->second.Nanoseconds;
}

double AimsTable::Counter(const std::string &name, const std::string &counter) const
{
    const auto found = _results.find(name);
    if (found == _results.end() || found->second.Counters.count(counter) == 0)
    {
        return 0.0;
    }
    return found->second.Counters.at(counter);
}

bool AimsTable::Print() const
{
    const double lock = Time("Reference/LockUnlock");
    const double clock = Time("Reference/ClockRead");
    std::vector<Row> rows;
    for (const char *copies : {"0", "1", "2", "3", "4"})
    {
        rows.push_back({std::string("post of a small message, ") + copies + " other copies",
                        "one clock read + 3 x lock", Time(std::string("Post/") + copies), clock + 3 * lock,
                        "ns"});
    }
    rows.push_back({"fetch with nothing new", "0.5 x lock", Time("FetchNothingNew"), 0.5 * lock, "ns"});
    rows.push_back(
        {"post and fetch", "one clock read + 5 x lock", Time("PostAndFetch"), clock + 5 * lock, "ns"});
    rows.push_back({"torn or older values fetched against a poster", "none",
                    Counter("FetchAgainstPoster", "wrong"), 0.0, ""});
    rows.push_back(
        {"queue, add and get, one thread", "6 x lock", Time("Queue/AddGetOneThread"), 6 * lock, "ns"});
    rows.push_back({"queue, make, add and get a message, one thread", "one clock read + 7 x lock",
                    Time("Queue/AddFreshMessage"), clock + 7 * lock, "ns"});
    rows.push_back(
        {"queue, each message through two threads", "100 ns", Time("Queue/ThroughTwoThreads"), 100.0, "ns"});
    for (const char *percentile : {"p50", "p99"})
    {
        const double reference = Counter("WakeUp", std::string("condvar_") + percentile);
        rows.push_back({std::string("wake-up on post, ") + percentile, "1.1 x condition variable",
                        Counter("WakeUp", std::string("post_") + percentile), 1.1 * reference, "ns"});
        rows.push_back({std::string("wake-up on enqueue, ") + percentile, "1.1 x condition variable",
                        Counter("WakeUp", std::string("queue_") + percentile), 1.1 * reference, "ns"});
    }
    rows.push_back({"50 idle managers, processor time a second", "1 ms",
                    Counter("FiftyIdleManagers", "cpu_ms_per_s"), 1.0, "ms"});
    rows.push_back(
        {"post of 1 MB", "1.1 x memcpy", Time("Post1MB"), 1.1 * Time("Reference/Memcpy1MB"), "ns"});

    std::printf(
        "\nlock and unlock %.1f ns, clock read %.1f ns, shared pointer copy %.1f ns, memcpy of 1 MB %.0f "
        "ns\n\n",
        lock, clock, Time("Reference/SharedPtrCopy"), Time("Reference/Memcpy1MB"));
    std::printf("| what | aim | at most | measured | met |\n|---|---|---|---|---|\n");
    bool allMet = true;
    for (const Row &row : rows)
    {
        const bool met = row.Measured <= row.Aim;
        allMet = allMet && met;
        std::printf("| %s | %s | %.1f %s | %.1f %s | %s |\n", row.What.c_str(), row.AimText.c_str(), row.Aim,
                    row.Unit, row.Measured, row.Unit, met ? "yes" : "no");
    }
    return allMet;
}
