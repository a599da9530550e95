#include <rabit/gateway/RandomSource.h>

#include <chrono>
#include <exception>
#include <random>

namespace Rabit
{

std::uint64_t SystemRandom() noexcept
{
    try
    {
        std::random_device device;
        return (std::uint64_t{device()} << 32) | device();
    }
    catch (const std::exception &)
    {
        // The low bits of a fast clock differ from incarnation to incarnation as well; the multiplier (the
        // 64-bit golden ratio) spreads them over the whole word.
        const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
        return static_cast<std::uint64_t>(now) * 0x9E3779B97F4A7C15U;
    }
}

}  // namespace Rabit
