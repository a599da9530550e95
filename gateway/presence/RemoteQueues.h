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

    // `ownNode` is who would send.
    explicit RemoteQueues(std::string ownNode) : _ownNode(std::move(ownNode)) {}

    // Takes over what the node announces; nothing if it has not announced anything yet.
    void Update(const PeerTable::Peer &peer);
    void Forget(const std::string &node);
    // Whether the node has announced itself.
    bool Knows(const std::string &node) const;
    Answer Ask(const std::string &node, const std::string &queue, const std::string &type,
               std::uint64_t definition) const;
    // Nodes that are there (not LOST) and accept that queue with that type, by name.
    std::vector<std::string> LiveNodesAccepting(const std::string &queue, const std::string &type,
                                                std::uint64_t definition) const;

private:
    const std::string _ownNode;
    mutable std::mutex _mutex;
    std::map<std::string, PeerTable::Peer> _peers;
};

}  // namespace Rabit
