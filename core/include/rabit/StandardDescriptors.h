#pragma once

namespace Rabit
{

// Opens /dev/null as each of the descriptors 0, 1 and 2 that is closed. Otherwise the next file or socket
// gets that number. The program's standard output or log then goes into it (POSIX.1-2017, exec, "Rationale").
//
// To be called first in main(), before other threads are started. A RabitReactor calls it when it is made.
void OpenStandardDescriptors() noexcept;

}  // namespace Rabit
