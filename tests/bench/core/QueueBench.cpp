#include "BenchMessages.h"

#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitNonBlockingSPSCQueue.h>

#include <benchmark/benchmark.h>

#include <chrono>
#include <memory>
#include <thread>

namespace
{

using namespace Rabit;
using Message = std::shared_ptr<RabitMessage>;

template <typename Queue>
void AddAndGet(benchmark::State &state)
{
    Queue queue(1000, "Queue");
    const Message message = std::make_shared<PoseMessage>();
    Message taken;
    for (auto _ : state)
    {
        queue.AddMessage(message);
        queue.GetMessage(taken);
        benchmark::DoNotOptimize(taken);
    }
}
BENCHMARK(AddAndGet<RabitMessageQueue<Message>>)->Name("Queue/AddGetOneThread");
BENCHMARK(AddAndGet<RabitNonBlockingSPSCQueue<Message>>)->Name("SpscQueue/AddGetOneThread");

// A message is made, added, taken and destroyed.
void AddFreshMessage(benchmark::State &state)
{
    RabitMessageQueue<Message> queue(1000, "Queue");
    Message taken;
    for (auto _ : state)
    {
        queue.AddMessage(std::make_shared<PoseMessage>());
        queue.GetMessage(taken);
        benchmark::DoNotOptimize(taken);
    }
}
BENCHMARK(AddFreshMessage)->Name("Queue/AddFreshMessage");

// One thread adds and another gets. The time is for each message that went through. The pointers have no
// shared reference count, so that only the queue is measured.
template <typename Queue>
void ThroughTwoThreads(benchmark::State &state)
{
    constexpr int count = 200000;
    for (auto _ : state)
    {
        Queue queue(1000, "Queue");
        const Message message = std::make_shared<PoseMessage>();
        const auto start = std::chrono::steady_clock::now();
        std::thread adding(
            [&]
            {
                for (int i = 0; i < count;)
                {
                    // Not counted: an aliasing pointer has no reference count to share.
                    if (queue.AddMessage(Message(Message(), message.get())))
                    {
                        ++i;
                    }
                    else
                    {
                        std::this_thread::yield();
                    }
                }
            });
        Message taken;
        for (int i = 0; i < count;)
        {
            if (queue.GetMessage(taken))
            {
                ++i;
            }
            else
            {
                std::this_thread::yield();
            }
        }
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        adding.join();
        state.SetIterationTime(elapsed.count() / count);
    }
}
BENCHMARK(ThroughTwoThreads<RabitMessageQueue<Message>>)
    ->Name("Queue/ThroughTwoThreads")
    ->UseManualTime()
    ->Iterations(5);
BENCHMARK(ThroughTwoThreads<RabitNonBlockingSPSCQueue<Message>>)
    ->Name("SpscQueue/ThroughTwoThreads")
    ->UseManualTime()
    ->Iterations(5);

}  // namespace
