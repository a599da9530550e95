#pragma once

#include <cstdint>

namespace Rabit
{

// How many beats of one life of a node came, and how many did not, by the numbers that its writer gives them.
// One that was overtaken counts as not come.
class BeatCount
{
public:
    // More at once is no loss but another way of counting.
    static constexpr std::uint64_t LongestGap = 10'000;

    // A beat came that is newer than those before. 0: it has no number.
    void Add(std::uint64_t sequence)
    {
        ++_heard;
        if (_last > 0 && sequence > _last && sequence - _last <= LongestGap)
        {
            _missed += sequence - _last - 1;
        }
        _last = sequence;
    }

    std::uint64_t Heard() const { return _heard; }
    // Between the first that came and the last.
    std::uint64_t Missed() const { return _missed; }

private:
    std::uint64_t _heard = 0;
    std::uint64_t _missed = 0;
    std::uint64_t _last = 0;
};

}  // namespace Rabit
