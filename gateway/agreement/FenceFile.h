#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>

#include "incarnation/StoredNumber.h"

namespace Rabit
{

// Keeps the highest fence that a voter may have accepted in a file, so that fences rise over its restarts.
// Without a file, or if it was lost, fences begin at `floor`.
class FenceFile
{
public:
    // Fences of a second of the wall clock. With them fences rise from start to start, as long as fewer
    // claims are won, and a wall clock of 136 years is within ClaimBallots::LargestLeap.
    static constexpr std::uint64_t FencesOfASecond = 256;

    // An empty path: no file.
    FenceFile(std::filesystem::path file, std::uint64_t floor) : _file(std::move(file)), _floor(floor) {}

    // All fences up to this one may have been accepted.
    std::uint64_t Load()
    {
        return _file.empty()
                   ? _floor
                   : std::max(_floor, StoredNumber::Read(_file, std::numeric_limits<std::uint64_t>::max() / 2,
                                                         "fence", _error));
    }
    // Returns false if it could not be stored.
    bool Store(std::uint64_t upTo)
    {
        _error = _file.empty() ? "" : StoredNumber::Write(_file, upTo);
        return _error.empty();
    }
    // The failure of the last read or write, in one line; empty: there was none.
    const std::string &Error() const { return _error; }

private:
    const std::filesystem::path _file;
    const std::uint64_t _floor;
    std::string _error;
};

}  // namespace Rabit
