// Under which numbers the vendor is given the samples of a writer that repeats none.
#pragma once

#include <chrono>
#include <cstdint>

namespace Rabit::Rtps
{

// A reader that asks for nothing passes over all that comes below the highest number that it saw. So one
// forged number a little ahead of the true ones would silence the writer until it has come to that number
// itself. An honest writer's numbers and times (INFO_TS) rise together: who goes on below the highest number,
// but later than the sample that had it, did not write that one. With the third such sample in a row, none
// from above in between, numbers are handed on as if it had gone on from there. Old samples that come once
// more, or overtaken, are older than the highest, and stay below it. Where times did not rise with numbers (a
// clock that was set, a writer that passes on what others wrote) that does not hold: for Unsettled after such
// a sample numbers remain as they are.
// Not thread-safe.
class SampleNumbers
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    static constexpr std::chrono::seconds Unsettled{3};

    // The number to hand on for a sample, or for a fragment of one. `stamp` is when it was written, in
    // seconds and their 2^32nd parts; 0 if that is not told: numbers then remain as they are.
    std::int64_t Of(std::int64_t number, std::uint64_t stamp, TimePoint now);
    // In the writer's numbering.
    std::int64_t Highest() const { return _highest; }

private:
    struct Sample
    {
        std::int64_t Number = 0;
        std::uint64_t Stamp = 0;
    };

    void GoOn(const Sample &sample, TimePoint now);
    bool GoesBack(const Sample &sample, TimePoint now);

    std::int64_t _highest = 0;
    std::int64_t _added = 0;    // to the writer's numbers
    std::uint64_t _latest = 0;  // of the samples that went on
    TimePoint _wentOn{};
    std::uint64_t _doubtful = 0;  // far from the latest, so that another must agree first
    TimePoint _settled{};
    Sample _below;  // the last of those that went on below
    int _belowInARow = 0;
};

}  // namespace Rabit::Rtps
