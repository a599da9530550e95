// How long it takes to wake a sleeping manager, beside how long it takes to wake a thread that waits for a
// condition variable. The three are measured in turn, one sample each, so that they meet the same
// disturbances.
#include "BenchMessages.h"

#include <rabit/RabitManager.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace
{

using namespace Rabit;
using Clock = std::chrono::steady_clock;

// The time at which the woken thread ran, in nanoseconds of the steady clock; 0: not yet.
class Arrival
{
public:
    void Expect() { _at.store(0); }
    void Note() { _at.store(Clock::now().time_since_epoch().count()); }
    std::int64_t Await() const
    {
        while (_at.load() == 0)
        {
            std::this_thread::yield();
        }
        return _at.load();
    }

private:
    std::atomic<std::int64_t> _at{1};
};

class WaitingThread
{
public:
    explicit WaitingThread(Arrival &arrival) : _arrival(arrival), _thread([this] { Run(); }) {}
    ~WaitingThread()
    {
        _stop = true;
        Wake();
        _thread.join();
    }
    void Wake()
    {
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            _woken = true;
        }
        _changed.notify_one();
    }

private:
    void Run()
    {
        while (!_stop)
        {
            {
                std::unique_lock<std::mutex> lock(_mutex);
                _changed.wait(lock, [this] { return _woken; });
                _woken = false;
            }
            _arrival.Note();
        }
    }

    Arrival &_arrival;
    std::mutex _mutex;
    std::condition_variable _changed;
    bool _woken = false;
    std::atomic<bool> _stop{false};
    std::thread _thread;
};

class WaitingManager : public RabitManager
{
public:
    WaitingManager(const char *name, RabitWorkspace &workspace, Arrival &arrival)
        : RabitManager(name, workspace), _arrival(arrival)
    {
        SetWakeupTimeDelaySec(1e6);
    }
    void ExecuteUnitOfWork() final
    {
        _arrival.Note();
        std::shared_ptr<RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
        }
    }

private:
    Arrival &_arrival;
};

double Percentile(std::vector<double> &samples, double fraction)
{
    const auto index = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(samples.size() - 1));
    std::nth_element(samples.begin(), samples.begin() + index, samples.end());
    return samples[static_cast<std::size_t>(index)];
}

template <typename Cause>
double NanosecondsToArrival(Arrival &arrival, Cause cause)
{
    // Long enough for the thread to be asleep again.
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    arrival.Expect();
    const std::int64_t start = Clock::now().time_since_epoch().count();
    cause();
    return static_cast<double>(arrival.Await() - start);
}

void WakeUp(benchmark::State &state)
{
    constexpr int samples = 2000;
    RabitWorkspace workspace;
    Arrival referenceArrival;
    Arrival postArrival;
    Arrival queueArrival;
    WaitingThread reference(referenceArrival);
    WaitingManager onPost("OnPost", workspace, postArrival);
    WaitingManager onQueue("OnQueue", workspace, queueArrival);
    const auto message = std::make_shared<PoseMessage>();
    const auto watched = std::make_shared<PoseMessage>();
    workspace.AddPublishSubscribeMessage("Pose", message);
    onPost.AddPublishSubscribeMessage("Pose", watched);
    onPost.WakeUpManagerOnMessagePost(watched);
    postArrival.Expect();
    queueArrival.Expect();
    onPost.Run();
    onQueue.Run();
    postArrival.Await();
    queueArrival.Await();
    const auto queue = onQueue.GetManagerMessageQueue();
    std::vector<double> byCondition;
    std::vector<double> byPost;
    std::vector<double> byQueue;
    for (auto _ : state)
    {
        for (int i = 0; i < samples; ++i)
        {
            byCondition.push_back(NanosecondsToArrival(referenceArrival, [&] { reference.Wake(); }));
            byPost.push_back(NanosecondsToArrival(postArrival, [&] { message->PostMessage(); }));
            byQueue.push_back(NanosecondsToArrival(queueArrival, [&] { queue->AddMessage(message); }));
        }
    }
    onPost.ShutdownManager();
    onQueue.ShutdownManager();
    onPost.Join();
    onQueue.Join();
    state.counters["condvar_p50"] = Percentile(byCondition, 0.5);
    state.counters["condvar_p99"] = Percentile(byCondition, 0.99);
    state.counters["post_p50"] = Percentile(byPost, 0.5);
    state.counters["post_p99"] = Percentile(byPost, 0.99);
    state.counters["queue_p50"] = Percentile(byQueue, 0.5);
    state.counters["queue_p99"] = Percentile(byQueue, 0.99);
}
BENCHMARK(WakeUp)->Iterations(1)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
