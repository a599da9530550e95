#include <rabit/RabitReactor.h>

#include <benchmark/benchmark.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <memory>
#include <string>
#include <thread>

namespace
{

using namespace Rabit;

class IdleManager : public RabitManager
{
public:
    IdleManager(const std::string &name, RabitWorkspace &workspace, std::atomic<int> &started)
        : RabitManager(name, workspace), _started(started)
    {
    }
    void Startup() final { ++_started; }
    void ExecuteUnitOfWork() final {}

private:
    std::atomic<int> &_started;
};

double ProcessCpuSeconds()
{
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Processor time that 50 managers with a timer of 1 s and nothing to do take in a second.
void FiftyIdleManagers(benchmark::State &state)
{
    constexpr int managers = 50;
    constexpr std::chrono::seconds time(5);
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    std::atomic<int> started{0};
    for (int i = 0; i < managers; ++i)
    {
        reactor.AddManager(std::make_unique<IdleManager>("Idle" + std::to_string(i), workspace, started));
    }
    std::thread running([&] { reactor.Run(); });
    while (started < managers)
    {
        std::this_thread::yield();
    }
    double used = 0.0;
    for (auto _ : state)
    {
        const double before = ProcessCpuSeconds();
        std::this_thread::sleep_for(time);
        used = ProcessCpuSeconds() - before;
    }
    reactor.ShutdownAllManagers();
    running.join();
    state.counters["cpu_ms_per_s"] = 1e3 * used / static_cast<double>(time.count());
}
BENCHMARK(FiftyIdleManagers)->Iterations(1)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
