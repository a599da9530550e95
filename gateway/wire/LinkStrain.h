#pragma once

#include <cstdint>

namespace Rabit
{

// A trouble of the queue messages between two nodes, as one of them reports it in its beats to programs that
// show the fleet.
struct LinkStrain
{
    enum class Kind : std::uint8_t
    {
        Filling = 1,  // the sender's outbox for that node fills, or was full lately
        InDoubt = 2,  // that node restarted lately before it acknowledged
        HeldBack = 3  // the sender of the beat is the receiver: messages of that node wait, since a queue of
                      // it is full or there is no memory for them
    };

    std::uint32_t Node = 0;  // tag of the other node
    Kind What = Kind::Filling;
    std::uint8_t Percent = 0;    // Filling: of the outbox's room, 0 to 100
    std::uint16_t Messages = 0;  // Filling: refused lately for want of room; InDoubt: messages in doubt;
                                 // 65535: or more

    bool operator==(const LinkStrain &) const = default;
};

}  // namespace Rabit
