#pragma once

#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>

namespace Rabit
{

// The token: the newest reading of a peer's clock that came, and when it came by this node's clock. Its echo
// proves to the peer that a frame is younger than Time, and bounds how long the frame was on its way.
struct PeerToken
{
    std::uint32_t Clock = 0;  // 0: none has come yet
    std::int64_t Time = 0;
    LinkTime CameAt{0};

    bool Known() const { return Clock != 0; }
};

}  // namespace Rabit
