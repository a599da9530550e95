#include "OutcomeHistory.h"

namespace Rabit
{

namespace
{

void ShiftIn(LinkBitmap &bits, bool newest)
{
    std::uint64_t carry = newest ? 1 : 0;
    for (std::uint64_t &word : bits)
    {
        const std::uint64_t out = word >> 63;
        word = (word << 1) | carry;
        carry = out;
    }
}

}  // namespace

void OutcomeHistory::Clear()
{
    _delivered = {};
    _refused = {};
}

void OutcomeHistory::Push(Entry entry)
{
    ShiftIn(_delivered, entry == Entry::Delivered);
    ShiftIn(_refused, entry == Entry::Refused);
}

bool OutcomeHistory::Test(const LinkBitmap &bits, std::uint64_t age)
{
    return age < LinkOutcomeBits && ((bits[age / 64] >> (age % 64)) & 1) != 0;
}

}  // namespace Rabit
