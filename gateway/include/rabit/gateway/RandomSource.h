#pragma once

#include <cstdint>
#include <functional>

namespace Rabit
{

// A source of 64 random bits at each call. A gateway needs few: to tell its clocks and lives from others.
// Simulations pass a seeded one. Must not throw; called by one thread at a time.
using RandomSource = std::function<std::uint64_t()>;

// From the system, or from a fast clock where the system has no source. Any thread.
std::uint64_t SystemRandom() noexcept;

}  // namespace Rabit
