#include "Counting.h"

#include "../common/Usage.h"

#include <cstdlib>
#include <iostream>

// A function with a plain name, for callgrind.
extern "C" [[gnu::noinline]] void Measured(const Rabit::Bench::Scenario &scenario, int messages)
{
    for (int i = 0; i < messages; i += scenario.AtOnce)
    {
        scenario.Message();
    }
}

namespace Rabit::Bench
{

int Count(int argc, char **argv, Scenario (*find)(const std::string &name))
{
    constexpr int warmUp = 2000;
    if (argc != 3)
    {
        std::cerr << "usage: " << argv[0] << " SCENARIO MESSAGES\n";
        return 2;
    }
    const int messages = std::atoi(argv[2]);
    const Scenario scenario = find(argv[1]);
    for (int i = 0; i < warmUp; i += scenario.AtOnce)
    {
        scenario.Message();
    }
    const std::uint64_t countBefore = scenario.Count();
    const std::uint64_t before = AllocationsSoFar();
    Measured(scenario, messages);
    const std::uint64_t allocations = AllocationsSoFar() - before;
    const std::uint64_t count = scenario.Count() - countBefore;
    std::cout << "{\"messages\": " << count
              << ", \"allocations\": " << static_cast<double>(allocations) / static_cast<double>(messages)
              << "}" << std::endl;
    // The messages accepted last may still be on their way.
    return count + 128 >= static_cast<std::uint64_t>(messages) ? 0 : 1;
}

}  // namespace Rabit::Bench
