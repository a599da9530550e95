#pragma once

#include <SimRandom.h>
#include "StoredMessages.h"

#include <cstddef>
#include <string>
#include <variant>

namespace Rabit::Sim
{

// A datagram on its way.
struct Packet
{
    std::size_t From = 0;
    std::size_t To = 0;
    std::variant<Test::StoredHello, Test::StoredAck, Test::StoredData> Message;
};

// Makes the message malformed in one of the ways that the receiver must notice.
void Spoil(Packet &packet, SimRandom &random);

// The incarnation that the message shows its sender to be in.
std::uint64_t IncarnationOf(const Packet &packet);

// For traces, in one line.
std::string Describe(const Packet &packet);

}  // namespace Rabit::Sim
