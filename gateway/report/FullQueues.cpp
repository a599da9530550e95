#include "report/FullQueues.h"

#include <rabit/base/ListedNames.h>

namespace Rabit
{
namespace
{

// Adds the number of messages of other nodes that were put into the queue, and returns the nodes of which
// messages wait.
std::vector<std::string> WaitingFor(const std::string &queue, const Gateway::Fleet &fleet,
                                    std::uint64_t &delivered)
{
    std::vector<std::string> waiting;
    for (const Gateway::InboundStatus &status : fleet.inbound)
    {
        if (status.queue == queue)
        {
            delivered += status.delivered;
            if (status.held_back)
            {
                waiting.push_back(status.node);
            }
        }
    }
    return waiting;
}

}  // namespace

FullQueues::Duration FullQueues::TakeIn(Queue &queue, std::uint64_t gotOn, std::uint64_t refused,
                                        Duration now)
{
    if (gotOn != queue.GotOn)
    {
        queue.StillSince = now;
    }
    if (refused > queue.Refused)
    {
        queue.LastRefused = now;
    }
    queue.GotOn = gotOn;
    queue.Refused = refused;
    return now - queue.StillSince;
}

std::vector<Gateway::Problem> FullQueues::Look(const std::vector<QueueInfo> &queues,
                                               const Gateway::Fleet &fleet, const PeersOverPaths &peers,
                                               Duration now)
{
    std::vector<Gateway::Problem> problems;
    LookHere(queues, fleet, now, problems);
    LookThere(fleet, peers, now, problems);
    return problems;
}

// A manager that takes a message from a full queue may not be seen: a sender of this process fills the place
// at once. So a queue that refuses is a problem while it is full at each look, and one that only holds other
// nodes back is none while messages of them are put into it.
void FullQueues::LookHere(const std::vector<QueueInfo> &queues, const Gateway::Fleet &fleet, Duration now,
                          std::vector<Gateway::Problem> &problems)
{
    std::map<std::string, Queue> full;
    for (const QueueInfo &info : queues)
    {
        if (info.FillLevel < info.Capacity)
        {
            continue;
        }
        std::uint64_t delivered = 0;
        const std::vector<std::string> waiting = WaitingFor(info.Name, fleet, delivered);
        const auto known = _here.find(info.Name);
        Queue &queue = full[info.Name];
        queue = known != _here.end() ? known->second : Queue{delivered, now, info.RefusedAdds, {}, {}};
        if (TakeIn(queue, delivered, info.RefusedAdds, now) < Patience)
        {
            continue;
        }
        const std::string isFull = "it is full (" + std::to_string(info.FillLevel) +
                                   (info.FillLevel == 1 ? " message)" : " messages)");
        if (!waiting.empty())
        {
            problems.push_back({"queue " + info.Name, waiting.size() == 1 ? waiting.front() : "",
                                isFull +
                                    ", and its manager takes no messages from it, or too few: those of " +
                                    ListedNames(waiting) + " wait"});
        }
        else if (HasRefusedLately(queue, now))
        {
            problems.push_back({"queue " + info.Name, "",
                                isFull + " and refuses messages: its manager takes none, or too few"});
        }
    }
    _here = std::move(full);
}

void FullQueues::LookThere(const Gateway::Fleet &fleet, const PeersOverPaths &peers, Duration now,
                           std::vector<Gateway::Problem> &problems)
{
    std::map<std::pair<std::string, std::string>, Queue> links;
    for (const Gateway::LinkStatus &link : fleet.links)
    {
        const auto known = _there.find({link.node, link.queue});
        Queue &queue = links[{link.node, link.queue}];
        queue = known != _there.end() ? known->second : Queue{0, now, 0, {}, {}};
        // Messages that expire meanwhile do not get on.
        const std::uint64_t gotOn = link.delivered + link.undeliverable;
        const Duration still = TakeIn(queue, gotOn, link.refused_full, now);
        if (link.held_back)
        {
            queue.LastHeld = now;
        }
        if (link.outbox == 0)
        {
            queue.StillSince = now;
            continue;
        }
        const PeerTable::Peer *const peer = peers.Find(link.node);
        const bool isLost = peer == nullptr || peer->State == Gateway::NodeState::LOST;
        const bool isHeld = !isLost && IsHeldLately(queue, now);
        const bool refuses = HasRefusedLately(queue, now);
        if ((!refuses && !isHeld) || still < (isLost || isHeld ? Patience : LongSending))
        {
            continue;
        }
        const std::string why = isLost   ? link.node + " is LOST"
                                : isHeld ? "that queue is full, not there, or without memory for it"
                                         : link.node + " has taken none for more than 10 s";
        problems.push_back(
            {"send " + link.node + "/" + link.queue, link.node,
             (refuses ? "no more messages may wait, and they are refused: " : "messages wait: ") + why});
    }
    _there = std::move(links);
}

}  // namespace Rabit
