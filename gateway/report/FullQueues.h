#pragma once

#include <rabit/RabitWorkspace.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway.idl.h"
#include "paths/PeersOverPaths.h"

namespace Rabit
{

// Finds the queues that stay full while messages for them are held back or refused: those of this node, and
// those of other nodes that its messages are for. No I/O, no threads, no clock of its own; gateway's thread
// only.
class FullQueues
{
public:
    using Duration = std::chrono::nanoseconds;

    // A full queue that takes a message within this time is worked through.
    static constexpr Duration Patience = std::chrono::seconds(3);
    // A node may take this long for a message, such as a large one over a thin channel, before a full outbox
    // is its fault.
    static constexpr Duration LongSending = std::chrono::seconds(10);
    // A refusal counts for this long.
    static constexpr Duration Memory = std::chrono::seconds(10);

    // Looks at the queues of this node, and at the links and inbound streams in `fleet`. `now` never goes
    // back.
    std::vector<Gateway::Problem> Look(const std::vector<QueueInfo> &queues, const Gateway::Fleet &fleet,
                                       const PeersOverPaths &peers, Duration now);

private:
    struct Queue
    {
        std::uint64_t GotOn = 0;  // messages that got on
        Duration StillSince{0};   // none has since then
        std::uint64_t Refused = 0;
        std::optional<Duration> LastRefused;
        std::optional<Duration> LastHeld;  // of a queue of another node
    };

    // Takes in the counters, which only rise. Returns for how long no message has got on.
    static Duration TakeIn(Queue &queue, std::uint64_t gotOn, std::uint64_t refused, Duration now);
    static bool HasRefusedLately(const Queue &queue, Duration now)
    {
        return queue.LastRefused && now - *queue.LastRefused < Memory;
    }
    // A queue that has room for a moment is held again at the next message.
    static bool IsHeldLately(const Queue &queue, Duration now)
    {
        return queue.LastHeld && now - *queue.LastHeld < Patience;
    }
    void LookHere(const std::vector<QueueInfo> &queues, const Gateway::Fleet &fleet, Duration now,
                  std::vector<Gateway::Problem> &problems);
    void LookThere(const Gateway::Fleet &fleet, const PeersOverPaths &peers, Duration now,
                   std::vector<Gateway::Problem> &problems);

    std::map<std::string, Queue> _here;                           // that are full
    std::map<std::pair<std::string, std::string>, Queue> _there;  // node, queue
};

}  // namespace Rabit
