#pragma once

#include <cstdint>
#include <string>

#include "presence/PeerTable.h"

namespace Rabit
{

// Whether a node accepts messages of a type for one of its queues, by its announcement.
enum class QueueAcceptance
{
    Accepted,
    UnknownNode,     // no node of that name has announced itself
    NotAnnounced,    // it was heard, but its announcement has not arrived
    UnknownQueue,    // it accepts no such queue
    NotFromHere,     // that queue does not take messages of this node
    WrongType,       // that queue does not take the type
    OtherDefinition  // it was built from another definition of the type
};

// `definition` is the hash of the type's IDL here, `sender` this node.
QueueAcceptance AcceptanceOf(const PeerTable::Peer &peer, const std::string &queue, const std::string &type,
                             std::uint64_t definition, const std::string &sender);

// The same in words, with what the node accepts instead; empty if it does accept.
std::string WhyNotAccepted(QueueAcceptance acceptance, const PeerTable::Peer &peer, const std::string &queue,
                           const std::string &type);

}  // namespace Rabit
