#pragma once

#include "../common/BenchOptions.h"

namespace Rabit::Bench
{

// Plays the role until it is over (ping, source, join) or the process is ended by a signal. Returns the exit
// code.
int RunRawRole(const BenchOptions &options);

}  // namespace Rabit::Bench
