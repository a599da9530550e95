#pragma once

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// Receives the guard's events about participants. Called on receiving threads with the guard's lock held: the
// implementation must be quick, and must not call the guard.
class PeerObserver
{
public:
    virtual ~PeerObserver() = default;
    // A datagram came from a participant whose announcement has not been admitted.
    virtual void HeardUnknown(const GuidPrefix &peer) = 0;
    // A participant announced itself on the network. `hasCard`: it says that it has a card.
    virtual void Announced(const GuidPrefix &peer, bool hasCard) = 0;
    // An endpoint of the participant's own has spoken for the first time (Ledger.h).
    virtual void Spoke(const GuidPrefix &peer) = 0;
    // A participant said goodbye.
    virtual void Gone(const GuidPrefix &peer) = 0;
    // True if the vendor learns of the participant's endpoints by other means than the network.
    virtual bool IsReplayed(const GuidPrefix &peer) const = 0;
};

}  // namespace Rabit::Rtps
