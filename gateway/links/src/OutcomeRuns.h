#pragma once

#include "OutcomeHistory.h"

#include <rabit/gateway/links/LinkMessages.h>

#include <cstdint>

namespace Rabit::OutcomeRuns
{

// The outcomes of an acknowledgement as runs of equal ones: nearly always all are delivered, which takes one
// byte. A run is a number: its length, and in the low two bits which outcome it is.
enum Kind : std::uint64_t
{
    Neither = 0,  // skipped
    Delivered = 1,
    Refused = 2
};

inline std::uint64_t KindOf(const LinkAck &ack, std::uint64_t sequence)
{
    return OutcomeHistory::Test(ack.Delivered, sequence) ? Delivered
           : OutcomeHistory::Test(ack.Refused, sequence) ? Refused
                                                         : Neither;
}

// Calls `visit` with each run from ack.Oldest to ack.Cumulative.
template <typename Visitor>
void Visit(const LinkAck &ack, const Visitor &visit)
{
    for (std::uint64_t sequence = ack.Oldest; sequence <= ack.Cumulative;)
    {
        const std::uint64_t kind = KindOf(ack, sequence);
        std::uint64_t length = 1;
        while (sequence + length <= ack.Cumulative && KindOf(ack, sequence + length) == kind)
        {
            ++length;
        }
        visit((length << 2) | kind);
        sequence += length;
    }
}

// The largest number that encodes a run of at most `length` outcomes.
inline std::uint64_t Largest(std::uint64_t length)
{
    return (length << 2) | Refused;
}

// Decodes a run that ends at ack.Cumulative or earlier. False if it is none.
inline bool Take(std::uint64_t run, std::uint64_t &sequence, LinkAck &ack)
{
    const std::uint64_t length = run >> 2;
    const std::uint64_t kind = run & 3;
    if (length == 0 || kind > Refused)
    {
        return false;
    }
    for (const std::uint64_t end = sequence + length; sequence < end; ++sequence)
    {
        OutcomeHistory::Assign(ack.Delivered, sequence, kind == Delivered);
        OutcomeHistory::Assign(ack.Refused, sequence, kind == Refused);
    }
    return true;
}

}  // namespace Rabit::OutcomeRuns
