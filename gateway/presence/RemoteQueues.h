#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "presence/PeerTable.h"
#include "presence/QueueAcceptance.h"

namespace Rabit
{

// Which queues the other nodes accept, for the callers of AddMessageToQueue. Written by the gateway's thread,
// read by any. A node stays in it while it is away, so that messages for it are accepted and wait.
// Thread-safe.
class RemoteQueues
{
public:
    struct Answer
    {
        QueueAcceptance What = QueueAcceptance::Accepted;
        std::string Reason;  // for people; empty if accepted
    };

    // `ownNode` is the sending node.
    explicit RemoteQueues(std::string ownNode) : _ownNode(std::move(ownNode)) {}

    // Copies the node's announcement; does nothing if it has not announced itself yet.
    void Update(const PeerTable::Peer &peer);
    void Forget(const std::string &node);
    // True if the node has announced itself.
    bool Knows(const std::string &node) const;
    Answer Ask(const std::string &node, const std::string &queue, const std::string &type,
               std::uint64_t definition) const;
    // Nodes, by name, that are not LOST and accept that type in that queue.
    std::vector<std::string> LiveNodesAccepting(const std::string &queue, const std::string &type,
                                                std::uint64_t definition) const;
    // After LiveNodesAccepting has returned none: why a live node does not accept that type in its queue of
    // that name. UnknownNode, without a reason, if none has a queue of that name.
    Answer WhyNoneAccepts(const std::string &queue, const std::string &type, std::uint64_t definition) const;

private:
    const std::string _ownNode;
    mutable std::mutex _mutex;
    std::map<std::string, PeerTable::Peer> _peers;
};

}  // namespace Rabit
