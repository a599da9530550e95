#pragma once

#include <rabit/gateway/TrafficClass.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "air/TrafficClassWords.h"

namespace Rabit
{

// Which class sends next, of those that have something to send.
//
// Command to Bulk: deficit round robin (Shreedhar and Varghese 1995), with two differences. Within a round
// the most important class goes first as long as it has credit, so that a command waits for a datagram under
// way and not for a round. And a class may overdraw its credit by a datagram and pays it back in the next
// rounds, so that rounds may be shorter than datagrams. Shares, where all have something to send: 32 : 8 : 3
// : 2. Where a class has nothing to send its share is that of the others; it keeps the credit of one round at
// most.
//
// Presence: goes before all others as long as it has credit; it earns a third of the bytes that others send,
// which makes it a quarter of all at most. What it sends while nobody else wants to is free.
class ClassShares
{
public:
    using Waiting = std::array<bool, TrafficClassCount>;  // by class

    // Credit in each round, bytes. A round is short, so that telemetry does not wait for the 1600 bytes of
    // commands that it has earned to pass by with 150 of its own: that is seconds with a small budget.
    static constexpr std::array<std::int64_t, TrafficClassCount> Quantum = {0, 256, 64, 24, 16};
    static constexpr std::int64_t PresenceEarns = 3;  // one byte for so many of the others

    // By which presence may go ahead after a pause; bytes.
    void SetPresenceBurst(std::int64_t bytes);

    // At least one waits. Begins a round where one is needed; the answer is the same until something is
    // charged or waits.
    TrafficClass Next(const Waiting &waiting);
    // So many bytes were sent, and so many of other classes wait.
    void Charge(TrafficClass traffic, std::size_t bytes, const Waiting &waiting);

private:
    void BeginRounds(const Waiting &waiting);

    std::array<std::int64_t, TrafficClassCount> _credit = Quantum;
    std::int64_t _presenceBurst = 1400;
    std::int64_t _presence = 1400;
};

}  // namespace Rabit
