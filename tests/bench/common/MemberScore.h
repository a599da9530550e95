#pragma once

#include "BenchOptions.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace Rabit::Bench
{

// What a member of a fleet has heard and used. Prints a line of JSON, at once, when every other member was
// heard for the first time, and one more for each SIGUSR1, so that who measures can take the difference of
// two. Members are numbered from 1. One thread at a time; one score in a process.
class MemberScore
{
public:
    // Listens to SIGUSR1 from here on.
    explicit MemberScore(const BenchOptions &options);
    void Sent() { ++_sent; }
    // A sample of that member has come. Numbers outside the fleet are counted as strangers.
    void Heard(std::size_t member);
    // To be called often: prints if a signal has come since the last call.
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
