#pragma once

#include <rabit/gateway/Fleet.h>

#include <set>
#include <string>

namespace Rabit
{

// Finds the new problems of a fleet. Texts that differ in digits alone are one problem. Problems of the
// recording itself are ignored. Not thread-safe.
class ProblemWatch
{
public:
    // Returns the first new problem in words; empty if none is new.
    std::string Look(const Gateway::Fleet &fleet);

private:
    std::set<std::string> _there;
};

}  // namespace Rabit
