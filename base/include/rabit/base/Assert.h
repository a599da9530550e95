#pragma once

#include <cstdio>
#include <cstdlib>

namespace Rabit
{

[[noreturn]] inline void FailAssertion(const char *condition, const char *file, int line)
{
    std::fprintf(stderr, "%s:%d: the invariant does not hold: %s\n", file, line, condition);
    std::abort();
}

}  // namespace Rabit

// States an invariant. Builds for debugging and with sanitizers check it, and end the program where it does
// not hold. Others do not evaluate it. Not for public headers, and not for what comes from outside.
#ifdef NDEBUG
#define RABIT_ASSERT(condition) static_cast<void>(sizeof(!(condition)))
#else
#define RABIT_ASSERT(condition) \
    ((condition) ? static_cast<void>(0) : Rabit::FailAssertion(#condition, __FILE__, __LINE__))
#endif
