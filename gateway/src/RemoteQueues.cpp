#include "RemoteQueues.h"

#include "Diagnosis.h"

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

RemoteQueues::Answer RemoteQueues::Ask(const std::string &node, const std::string &queue,
                                       const std::string &type, std::uint64_t definition) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _peers.find(node);
    if (found == _peers.end())
    {
        return {Verdict::UnknownNode, "no node `" + node + "` has announced itself"};
    }
    const Diagnosis::Acceptance acceptance = Diagnosis::OfQueue(found->second, queue, type, definition);
    return {acceptance.QueueKnown ? (acceptance.Reason.empty() ? Verdict::Accepted : Verdict::WrongType)
                                  : Verdict::UnknownQueue,
            acceptance.Reason};
}

std::vector<std::string> RemoteQueues::LiveNodesAccepting(const std::string &queue, const std::string &type,
                                                          std::uint64_t definition) const
{
    const std::lock_guard lock(_mutex);
    std::vector<std::string> nodes;
    for (const auto &[name, peer] : _peers)
    {
        if (peer.State != Gateway::NodeState::LOST &&
            Diagnosis::OfQueue(peer, queue, type, definition).Reason.empty())
        {
            nodes.push_back(name);
        }
    }
    return nodes;
}

}  // namespace Rabit
