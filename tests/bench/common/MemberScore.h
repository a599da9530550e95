#pragma once

#include "BenchOptions.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace Rabit::Bench
{

// Measures what a member of a fleet has heard and used. Prints a line of JSON as soon as every other member
// was heard for the first time, and one more for each SIGUSR1; the difference of two lines is the
// measurement. Members are numbered from 1. One thread at a time; one score in a process.
class MemberScore
{
public:
    // Listens to SIGUSR1 from here on.
    explicit MemberScore(const BenchOptions &options);
    void Sent() { ++_sent; }
    // Counts a sample of this member. Numbers outside the fleet are counted as strangers.
    void Heard(std::size_t member);
    // Prints a line if a signal has come since the last call. Call it often.
    void ReportIfAsked();

private:
    void Report() const;
    std::string Missing() const;

    std::vector<bool> _heard;  // by number; itself from the start
    std::size_t _missing;
    std::uint64_t _sent = 0;
    std::uint64_t _received = 0;
    std::uint64_t _strangers = 0;
};

}  // namespace Rabit::Bench
