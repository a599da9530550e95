#pragma once

#include <rabit/gateway/Fleet.h>

#include <set>
#include <string>

namespace Rabit
{

// Tells which problems of a fleet were not there before. Texts that differ in numbers alone are one; those of
// the recording itself are none. Not thread-safe.
class ProblemWatch
{
public:
    // The problem in words; empty: none is new.
    std::string Look(const Gateway::Fleet &fleet);

private:
    std::set<std::string> _there;
};

}  // namespace Rabit
