#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace Rabit::Sim
{

// Something counted in a run: to see that a simulation tries what it is meant to try.
struct Figure
{
    enum class Kind
    {
        Sum,      // adds up over the seeds, and must not stay 0
        Largest,  // of the seeds, in nanoseconds
        LargestPercent,
    };

    const char *Name = "";
    std::uint64_t Value = 0;
    Kind How = Kind::Sum;
};

struct SeedResult
{
    std::string Failure;          // empty: all invariants held
    std::vector<Figure> Figures;  // the same ones, in the same order, for every seed
};

// Runs the scenario of one seed to its end, or to the first violation. With a trace, each event is written to
// it as a line; the run is the same. Called on several threads at once.
using SeedFunction = std::function<SeedResult(std::uint64_t seed, std::ostream *trace)>;

// The main function of a simulation program:
//
//   program --seeds 20000 [--first 1] [--jobs 2] [--require-coverage]
//   program --seed 4711 [--trace]
//
// Prints what happened in total. On a violation: the seed, the commit and the last events, and exit status 1;
// the same if a figure stays 0 where coverage is required. What cannot be understood: exit status 2.
int RunSeeds(const char *program, int argc, char **argv, const SeedFunction &run);

}  // namespace Rabit::Sim
