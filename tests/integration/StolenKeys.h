// Keys of another node, for tests of which sender is accepted.
#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>

namespace TestNode
{

// Returns a backend whose sessions use the keys in `folder`, whatever the node calls itself: the gateway
// does not check whether they fit. Writers go where the keys allow: into the partition of the keys' owner
// instead of the node's own. Opening throws Rabit::TransportError if the folder has no keys.
std::shared_ptr<Rabit::Transport> WithStolenKeys(std::shared_ptr<Rabit::Transport> backend,
                                                 const std::string &folder);

}  // namespace TestNode
