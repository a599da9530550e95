#include "BenchMessages.h"

#include <rabit/RabitWorkspace.h>

#include <benchmark/benchmark.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

namespace
{

using namespace Rabit;

void Post(benchmark::State &state)
{
    RabitWorkspace workspace;
    const auto poster = std::make_shared<PoseMessage>();
    workspace.AddPublishSubscribeMessage("Pose", poster);
    std::vector<std::shared_ptr<PoseMessage>> copies;
    for (int i = 0; i < state.range(0); ++i)
    {
        copies.push_back(std::make_shared<PoseMessage>());
        workspace.AddPublishSubscribeMessage("Pose", copies.back());
    }
    for (auto _ : state)
    {
        ++poster->Count;
        poster->PostMessage();
    }
}
BENCHMARK(Post)->Arg(0)->Arg(1)->Arg(2)->Arg(3)->Arg(4);

void FetchNothingNew(benchmark::State &state)
{
    RabitWorkspace workspace;
    const auto reader = std::make_shared<PoseMessage>();
    workspace.AddPublishSubscribeMessage("Pose", reader);
    reader->PostMessage();
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(reader->FetchMessage());
    }
}
BENCHMARK(FetchNothingNew);

void PostAndFetch(benchmark::State &state)
{
    RabitWorkspace workspace;
    const auto poster = std::make_shared<PoseMessage>();
    const auto reader = std::make_shared<PoseMessage>();
    workspace.AddPublishSubscribeMessage("Pose", poster);
    workspace.AddPublishSubscribeMessage("Pose", reader);
    for (auto _ : state)
    {
        ++poster->Count;
        poster->PostMessage();
        if (!reader->FetchMessage())
        {
            state.SkipWithError("a fetch missed a post");
            break;
        }
    }
}
BENCHMARK(PostAndFetch);

// A reader that fetches as fast as it can from a thread that posts as fast as it can.
void FetchAgainstPoster(benchmark::State &state)
{
    RabitWorkspace workspace;
    const auto poster = std::make_shared<PoseMessage>();
    const auto reader = std::make_shared<PoseMessage>();
    workspace.AddPublishSubscribeMessage("Pose", poster);
    workspace.AddPublishSubscribeMessage("Pose", reader);
    std::atomic<bool> stop{false};
    std::thread posting(
        [&]
        {
            for (std::uint64_t count = 1; !stop.load(std::memory_order_relaxed); ++count)
            {
                poster->SetAll(count);
                poster->PostMessage();
            }
        });
    std::uint64_t last = 0;
    std::uint64_t fetched = 0;
    std::uint64_t wrong = 0;
    for (auto _ : state)
    {
        if (reader->FetchMessage())
        {
            ++fetched;
            wrong += (reader->Count < last || !reader->IsWhole()) ? 1 : 0;
            last = reader->Count;
        }
    }
    stop = true;
    posting.join();
    state.counters["new"] = static_cast<double>(fetched);
    state.counters["wrong"] = static_cast<double>(wrong);
}
BENCHMARK(FetchAgainstPoster)->UseRealTime();

void PostMegabyte(benchmark::State &state)
{
    RabitWorkspace workspace;
    const auto poster = std::make_shared<ImageMessage>();
    workspace.AddPublishSubscribeMessage("Image", poster);
    for (auto _ : state)
    {
        poster->PostMessage();
        benchmark::ClobberMemory();
    }
}
BENCHMARK(PostMegabyte)->Name("Post1MB");

}  // namespace
