#pragma once

#include <rabit/gateway/TrafficClass.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace Rabit
{

// Chooses the class that sends next, of those that have something to send.
//
// Command to Bulk: deficit round robin (Shreedhar and Varghese 1995), with two differences. Within a round
// the most important class goes first as long as it has credit. So a command waits for a datagram under way
// and not for a round. And a class may overdraw its credit by a datagram, and pays it back in the next
// rounds. So rounds may be shorter than datagrams. Shares, where all have something to send, are those of
// TrafficClasses. The share of an idle class goes to the others; it keeps the credit of one round at most.
//
// Presence: goes before all others as long as it has credit. It earns a third of the bytes that others send,
// so its share is a quarter at most. Bytes that it sends while no other class waits are free.
class ClassShares
{
public:
    using Waiting = std::array<bool, TrafficClassCount>;  // by class

    // Credit in each round, bytes, for each unit of a share. A round is short, since otherwise telemetry
    // would wait, for 150 bytes of its own, until 1600 bytes of commands have passed: seconds with a small
    // budget.
    static constexpr std::int64_t BytesPerShare = 8;
    static constexpr std::int64_t PresenceEarns = 3;  // one byte for this many of the others

    ClassShares();

    // Sets the bytes that presence may send ahead of its credit after a pause.
    void SetPresenceBurst(std::int64_t bytes);

    // Returns the next class. At least one must wait. Begins a round if needed; returns the same until bytes
    // are charged or another class waits.
    TrafficClass Next(const Waiting &waiting);
    // True if the class may send in this round.
    bool HasCredit(TrafficClass traffic) const
    {
        return (traffic == TrafficClass::Presence ? _presence : _credit[static_cast<std::size_t>(traffic)]) >
               0;
    }
    // The class sent `bytes` bytes; `waiting` are the classes that wait.
    void Charge(TrafficClass traffic, std::size_t bytes, const Waiting &waiting);

private:
    void BeginRounds(const Waiting &waiting);

    std::array<std::int64_t, TrafficClassCount> _credit;
    std::int64_t _presenceBurst = 1400;
    std::int64_t _presence = 1400;
};

}  // namespace Rabit
