#include "presence/QueueAcceptance.h"

#include <rabit/base/ListedNames.h>
#include <rabit/gateway/NamePattern.h>

#include <algorithm>

namespace Rabit
{
namespace
{

const Gateway::AcceptedQueue *FindQueue(const PeerTable::Peer &peer, const std::string &queue)
{
    const auto &queues = peer.Offers->accepts;
    const auto found = std::find_if(queues.begin(), queues.end(),
                                    [&queue](const auto &accepted) { return accepted.queue == queue; });
    return found == queues.end() ? nullptr : &*found;
}

std::string QueuesOf(const PeerTable::Peer &peer)
{
    const auto &queues = peer.Offers->accepts;
    return queues.empty() ? "nothing"
                          : ListedNames(queues, [](const auto &accepted) { return accepted.queue; });
}

}  // namespace

QueueAcceptance AcceptanceOf(const PeerTable::Peer &peer, const std::string &queue, const std::string &type,
                             std::uint64_t definition, const std::string &sender)
{
    if (!peer.Offers)
    {
        return QueueAcceptance::NotAnnounced;
    }
    const Gateway::AcceptedQueue *found = FindQueue(peer, queue);
    if (found == nullptr)
    {
        return QueueAcceptance::UnknownQueue;
    }
    if (std::none_of(found->from.begin(), found->from.end(),
                     [&sender](const std::string &pattern) { return MatchesPattern(pattern, sender); }))
    {
        return QueueAcceptance::NotFromHere;
    }
    const auto fits = std::find_if(found->types.begin(), found->types.end(),
                                   [&type](const auto &accepted) { return accepted.type == type; });
    if (fits == found->types.end())
    {
        return QueueAcceptance::WrongType;
    }
    return fits->definition == definition ? QueueAcceptance::Accepted : QueueAcceptance::OtherDefinition;
}

std::string WhyNotAccepted(QueueAcceptance acceptance, const PeerTable::Peer &peer, const std::string &queue,
                           const std::string &type)
{
    switch (acceptance)
    {
        case QueueAcceptance::Accepted:
            break;
        case QueueAcceptance::UnknownNode:
            break;
        case QueueAcceptance::NotAnnounced:
            return "no announcement of " + peer.Node + " has arrived yet";
        case QueueAcceptance::UnknownQueue:
            return peer.Node + " accepts no queue `" + queue + "`; it accepts " + QueuesOf(peer);
        case QueueAcceptance::NotFromHere:
            return "queue `" + queue + "` of " + peer.Node + " accepts no messages of this node, but of " +
                   ListedNames(FindQueue(peer, queue)->from);
        case QueueAcceptance::WrongType:
            return "queue `" + queue + "` of " + peer.Node + " does not accept `" + type + "`; it accepts " +
                   ListedNames(FindQueue(peer, queue)->types, [](const auto &taken) { return taken.type; });
        case QueueAcceptance::OtherDefinition:
            return peer.Node + " was built with another definition of `" + type + "`";
    }
    return "";
}

}  // namespace Rabit
