#pragma once

#include <SimRandom.h>
#include <rabit/gateway/links/LinkMessages.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace Rabit::Sim
{

// A datagram on its way, as bytes.
struct Packet
{
    std::size_t From = 0;
    std::size_t To = 0;
    std::uint64_t SenderLife = 0;  // the incarnation that its sender was in
    std::vector<std::uint8_t> Bytes;
};

// Makes the frame malformed in one of the ways that the receiver must notice.
void Spoil(LinkFrame &frame, SimRandom &random);

// Returns a line for traces.
std::string Describe(const Packet &packet);

}  // namespace Rabit::Sim
