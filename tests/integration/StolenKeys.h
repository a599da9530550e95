// Somebody else's keys, for tests of who is believed.
#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>

namespace TestNode
{

// A backend whose sessions have the keys in that folder, whatever the node calls itself: the gateway above is
// not asked whether they fit. Writers are put where the keys allow it: into the partition of their owner in
// place of the node's own. Opening throws Rabit::TransportError if the folder is none of keys.
std::shared_ptr<Rabit::Transport> WithStolenKeys(std::shared_ptr<Rabit::Transport> backend,
                                                 const std::string &folder);

}  // namespace TestNode
