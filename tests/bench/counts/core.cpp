// Posts, fetches and queues of the in-process core, on one thread. The clock is replaced by one of which each
// reading takes 10 ns, less than on any computer: so a message that waits for the clock costs many readings,
// in every run alike. Its arguments and its output: Counting.h.
#include "../core/BenchMessages.h"
#include "Counting.h"

#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitWorkspace.h>

#include <cstdint>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <string>

namespace
{

constexpr std::int64_t Second = 1000000000;
// Nanoseconds.
std::int64_t now = 1800000000 * Second;

}  // namespace

// Replaces the C library's function.
extern "C" int clock_gettime(clockid_t, std::timespec *time) noexcept
{
    now += 10;
    time->tv_sec = now / Second;
    time->tv_nsec = now % Second;
    return 0;
}

namespace Rabit::Bench
{
namespace
{

// One name, its poster and its reader.
struct Pair
{
    RabitWorkspace Workspace;
    std::shared_ptr<PoseMessage> Poster = std::make_shared<PoseMessage>();
    std::shared_ptr<PoseMessage> Reader = std::make_shared<PoseMessage>();
    std::uint64_t Fetched = 0;

    Pair()
    {
        Workspace.AddPublishSubscribeMessage("Pose", Poster);
        Workspace.AddPublishSubscribeMessage("Pose", Reader);
    }
};

struct Queue
{
    RabitMessageQueue<std::shared_ptr<RabitMessage>> Messages{1000, "Queue"};
    std::shared_ptr<RabitMessage> Taken;
    std::uint64_t NumberTaken = 0;
};

Scenario Find(const std::string &name)
{
    const auto pair = std::make_shared<Pair>();
    if (name == "post")
    {
        return {[pair] { pair->Poster->PostMessage(); },
                [pair] { return pair->Poster->GetGlobalPublishSubscribeMessageRef()->GetNumberOfPosts(); }};
    }
    if (name == "post-fetch")
    {
        return {[pair]
                {
                    pair->Poster->PostMessage();
                    pair->Fetched += pair->Reader->FetchMessage() ? 1 : 0;
                },
                [pair] { return pair->Fetched; }};
    }
    if (name == "queue-add")
    {
        const auto queue = std::make_shared<Queue>();
        return {[queue]
                {
                    queue->Messages.AddMessage(std::make_shared<PoseMessage>());
                    queue->NumberTaken += queue->Messages.GetMessage(queue->Taken) ? 1 : 0;
                },
                [queue] { return queue->NumberTaken; }};
    }
    throw std::invalid_argument("there is no scenario " + name);
}

}  // namespace
}  // namespace Rabit::Bench

int main(int argc, char **argv)
{
    return Rabit::Bench::Count(argc, argv, Rabit::Bench::Find);
}
