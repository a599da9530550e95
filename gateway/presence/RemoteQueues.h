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

    // Copies the node's announcement. A node that has none is kept as one of which nothing is known yet. If
    // it had one in an earlier incarnation, that one is over: the table of peers keeps it if the digest is
    // the same. In the same incarnation the former announcement holds until the next one has come.
    void Update(const PeerTable::Peer &peer);
    void Forget(const std::string &node);
    // True if the node has announced itself.
    bool Knows(const std::string &node) const;
    Answer Ask(const std::string &node, const std::string &queue, const std::string &type,
               std::uint64_t definition) const;
    // Nodes that are not LOST, by name.
    struct LiveNodes
    {
        std::vector<std::string> Accepting;     // that type in that queue
        std::vector<std::string> NotAnnounced;  // they may accept it: their announcement has not arrived
    };
    LiveNodes LiveNodesFor(const std::string &queue, const std::string &type, std::uint64_t definition) const;
    // After LiveNodesFor has returned none: why a live node does not accept that type in its queue of
    // that name. UnknownNode, without a reason, if none has a queue of that name.
    Answer WhyNoneAccepts(const std::string &queue, const std::string &type, std::uint64_t definition) const;

private:
    const std::string _ownNode;
    mutable std::mutex _mutex;
    std::map<std::string, PeerTable::Peer> _peers;
};

}  // namespace Rabit
