#include "presence/RemoteQueues.h"

namespace Rabit
{

void RemoteQueues::Update(const PeerTable::Peer &peer)
{
    const std::lock_guard lock(_mutex);
    const auto found = _peers.find(peer.Node);
    if (peer.Offers)
    {
        _peers[peer.Node] = peer;
    }
    else if (found != _peers.end())
    {
        found->second.State = peer.State;
    }
}

bool RemoteQueues::Knows(const std::string &node) const
{
    const std::lock_guard lock(_mutex);
    return _peers.count(node) > 0;
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

std::vector<std::string> RemoteQueues::LiveNodesAccepting(const std::string &queue, const std::string &type,
                                                          std::uint64_t definition) const
{
    const std::lock_guard lock(_mutex);
    std::vector<std::string> nodes;
    for (const auto &[name, peer] : _peers)
    {
        if (peer.State != Gateway::NodeState::LOST &&
            AcceptanceOf(peer, queue, type, definition, _ownNode) == QueueAcceptance::Accepted)
        {
            nodes.push_back(name);
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
