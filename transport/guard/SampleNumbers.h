// Renumbers the samples of a best-effort writer for the vendor.
#pragma once

#include <chrono>
#include <cstdint>

namespace Rabit::Rtps
{

// A best-effort reader ignores all samples below the highest number that it saw. So one forged number a
// little ahead of the true ones would silence the writer until its own numbers get there. An honest writer's
// numbers and times (INFO_TS) rise together. A sample below the highest number, but later than the sample
// that had it, shows that the writer did not write that one. With the third such sample in a row, and none
// above in between, numbers are given out as if the writer had gone on from there. Duplicate or overtaken
// samples are older than the highest, and stay below it. If times did not rise with numbers (a clock that was
// set, a writer that relays samples of others) this does not hold: for Unsettled after such a sample numbers
// remain unchanged. Not thread-safe.
class SampleNumbers
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    static constexpr std::chrono::seconds Unsettled{3};

    // The number to give the vendor for a sample, or for a fragment of one. `stamp` is its time of writing in
    // units of 2^-32 s; 0 if unknown: numbers then remain unchanged.
    std::int64_t Of(std::int64_t number, std::uint64_t stamp, TimePoint now);
    // In the writer's own numbering.
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
    std::uint64_t _latest = 0;  // time of the samples that went on
    TimePoint _wentOn{};
    std::uint64_t _doubtful = 0;  // time far from the latest, so that another sample must agree first
    TimePoint _settled{};
    Sample _below;  // the last sample that went on below
    int _belowInARow = 0;
};

}  // namespace Rabit::Rtps
