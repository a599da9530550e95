#pragma once

#include <rabit/gateway/links/LinkMessages.h>

namespace Rabit
{

// The outcomes of the last LinkWindowParts parts that a receiver consumed, in rings of bits: part n is bit n
// modulo their size, so that nothing has to be shifted.
class OutcomeHistory
{
public:
    enum class Entry
    {
        Delivered,  // also of a part that does not end its message
        Skipped,
        Refused
    };

    void Clear()
    {
        _delivered = {};
        _refused = {};
    }
    void Set(std::uint64_t sequence, Entry entry)
    {
        Assign(_delivered, sequence, entry == Entry::Delivered);
        Assign(_refused, sequence, entry == Entry::Refused);
    }
    const LinkBitmap &Delivered() const { return _delivered; }
    const LinkBitmap &Refused() const { return _refused; }

    static bool Test(const LinkBitmap &bits, std::uint64_t sequence)
    {
        return ((bits[(sequence / 64) % bits.size()] >> (sequence % 64)) & 1) != 0;
    }
    static void Assign(LinkBitmap &bits, std::uint64_t sequence, bool value)
    {
        std::uint64_t &word = bits[(sequence / 64) % bits.size()];
        const std::uint64_t bit = std::uint64_t{1} << (sequence % 64);
        word = value ? word | bit : word & ~bit;
    }

private:
    LinkBitmap _delivered{};
    LinkBitmap _refused{};
};

}  // namespace Rabit
