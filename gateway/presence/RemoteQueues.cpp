#include "presence/RemoteQueues.h"

namespace Rabit
{

void RemoteQueues::Update(const PeerTable::Peer &peer)
{
    const std::lock_guard lock(_mutex);
    const auto found = _peers.find(peer.Node);
    if (peer.Offers || found == _peers.end() || peer.Incarnation > found->second.Incarnation)
    {
        _peers[peer.Node] = peer;
    }
    else
    {
        found->second.State = peer.State;
    }
}

bool RemoteQueues::Knows(const std::string &node) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _peers.find(node);
    return found != _peers.end() && found->second.Offers;
}

void RemoteQueues::Forget(const std::string &node)
{
    const std::lock_guard lock(_mutex);
    _peers.erase(node);
}

RemoteQueues::Answer RemoteQueues::Ask(const std::string &node, const std::string &queue,
                                       const std::string &type, std::uint64_t definition) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _peers.find(node);
    if (found == _peers.end())
    {
        return {QueueAcceptance::UnknownNode, "no node `" + node + "` has announced itself"};
    }
    const QueueAcceptance acceptance = AcceptanceOf(found->second, queue, type, definition, _ownNode);
    return {acceptance, WhyNotAccepted(acceptance, found->second, queue, type)};
}

RemoteQueues::LiveNodes RemoteQueues::LiveNodesFor(const std::string &queue, const std::string &type,
                                                   std::uint64_t definition) const
{
    const std::lock_guard lock(_mutex);
    LiveNodes nodes;
    for (const auto &[name, peer] : _peers)
    {
        if (peer.State == Gateway::NodeState::LOST)
        {
            continue;
        }
        const QueueAcceptance acceptance = AcceptanceOf(peer, queue, type, definition, _ownNode);
        if (acceptance == QueueAcceptance::Accepted)
        {
            nodes.Accepting.push_back(name);
        }
        else if (acceptance == QueueAcceptance::NotAnnounced)
        {
            nodes.NotAnnounced.push_back(name);
        }
    }
    return nodes;
}

RemoteQueues::Answer RemoteQueues::WhyNoneAccepts(const std::string &queue, const std::string &type,
                                                  std::uint64_t definition) const
{
    const std::lock_guard lock(_mutex);
    for (const auto &[name, peer] : _peers)
    {
        const QueueAcceptance acceptance = AcceptanceOf(peer, queue, type, definition, _ownNode);
        if (peer.State != Gateway::NodeState::LOST && acceptance != QueueAcceptance::UnknownQueue &&
            acceptance != QueueAcceptance::NotAnnounced && acceptance != QueueAcceptance::Accepted)
        {
            return {acceptance, WhyNotAccepted(acceptance, peer, queue, type)};
        }
    }
    return {QueueAcceptance::UnknownNode, ""};
}

}  // namespace Rabit
