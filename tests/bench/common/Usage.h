#pragma once

#include <cstdint>
#include <string>

namespace Rabit::Bench
{

// CLOCK_MONOTONIC in nanoseconds.
std::int64_t Now();

// Calls of malloc and its relatives in this process so far, by all its threads and libraries.
std::uint64_t AllocationsSoFar();

// The resources that this process has used so far.
struct Usage
{
    std::int64_t Processor = 0;  // user and system time of all threads, ns
    std::uint64_t Allocations = 0;
    std::int64_t Switches = 0;  // voluntary context switches: how often a thread went to sleep

    static Usage Take();
};

// "cpu_ns": .., "allocations": .., "sleeps": .. for each of `messages`, for a JSON object.
std::string PerMessage(const Usage &before, const Usage &after, std::uint64_t messages);

}  // namespace Rabit::Bench
