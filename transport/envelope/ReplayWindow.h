#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace Rabit::Envelope
{

// Which numbers of a sender were taken (RFC 4303, 3.4.3; the ring of words is that of RFC 6479). Checking
// changes nothing, so a number can be looked up before its datagram is verified, and marked afterwards.
class ReplayWindow
{
public:
    // Numbers that lie further below the highest one are refused, since nobody knows whether they were taken:
    // two radios and a relay reorder.
    static constexpr std::uint64_t Size = 4096;

    enum class Verdict : std::uint8_t
    {
        New,
        Seen,
        TooOld  // or before the floor
    };

    // The whole number whose low 32 bits these are: the one nearest to the highest number that was taken.
    // Before any number was taken, the low one.
    std::uint64_t Restore(std::uint32_t low) const
    {
        constexpr std::uint64_t Step = std::uint64_t{1} << 32;
        const std::uint64_t here = (_highest & ~(Step - 1)) | low;
        const std::uint64_t half = Step / 2;
        if (here < _highest && _highest - here > half && here <= ~Step)
        {
            return here + Step;
        }
        return here > _highest && here - _highest > half && here >= Step ? here - Step : here;
    }

    Verdict Look(std::uint64_t number) const
    {
        if (number < _floor || (number <= _highest && _highest - number >= Size))
        {
            return Verdict::TooOld;
        }
        return _any && number <= _highest && (WordOf(number) & BitOf(number)) != 0 ? Verdict::Seen
                                                                                   : Verdict::New;
    }

    // Takes a number, which must be New.
    void Mark(std::uint64_t number)
    {
        if (!_any || number > _highest)
        {
            // At most the whole ring is cleared, however far the number jumps.
            const std::uint64_t blocks =
                std::min<std::uint64_t>(number / Bits - _highest / Bits, _words.size());
            for (std::uint64_t i = 0; i < blocks; ++i)
            {
                WordOf(number - i * Bits) = 0;
            }
            _highest = number;
        }
        _any = true;
        WordOf(number) |= BitOf(number);
    }

    // From now on all lower numbers are TooOld.
    void SetFloor(std::uint64_t number) { _floor = std::max(_floor, number); }

    std::uint64_t Highest() const { return _highest; }

private:
    static constexpr std::uint64_t Bits = 64;

    static std::uint64_t BitOf(std::uint64_t number) { return std::uint64_t{1} << number % Bits; }
    std::uint64_t &WordOf(std::uint64_t number) { return _words[number / Bits % _words.size()]; }
    std::uint64_t WordOf(std::uint64_t number) const { return _words[number / Bits % _words.size()]; }

    // One word more than the window has: its numbers may begin and end within words.
    std::array<std::uint64_t, Size / Bits + 1> _words{};
    std::uint64_t _highest = 0;
    std::uint64_t _floor = 0;
    bool _any = false;
};

}  // namespace Rabit::Envelope
