#pragma once

#include <cstdint>

namespace Rabit
{

// Counts the beats of one incarnation of a node that came, and that did not, by their writer's sequence
// numbers. A beat that a newer one overtook counts as missed.
class BeatCount
{
public:
    // A larger gap means that the writer numbers otherwise, not that beats were lost.
    static constexpr std::uint64_t LongestGap = 10'000;

    // A beat came that is newer than those before. `sequence` 0: the beat has no number.
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
    // Beats that did not come, between the first and the last that came.
    std::uint64_t Missed() const { return _missed; }

private:
    std::uint64_t _heard = 0;
    std::uint64_t _missed = 0;
    std::uint64_t _last = 0;
};

}  // namespace Rabit
