#pragma once

#include "envelope/KeyDerivation.h"
#include "envelope/SecretKey.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// One session as `Sealer` needs it in pairwise mode. A copy, which nothing changes any more: it outlives its
// `Session`, and any thread may read it. Its key is that of one epoch: get another receiver
// (Session::ReceiverIn) once a newer epoch is known.
struct Receiver
{
    End Of;
    Envelope::Epoch Epoch = 0;
    SecretKey Key;
};

}  // namespace Rabit::Envelope
