#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace Rabit::Sim
{

// A count of one kind of event in a run, to see that a simulation tries what it is meant to try.
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
// Prints the totals. On a violation, prints the seed, the commit and the last events; the exit status is 1.
// The status is also 1 if a figure stays 0 and coverage is required. It is 2 if an argument is wrong.
int RunSeeds(const char *program, int argc, char **argv, const SeedFunction &run);

}  // namespace Rabit::Sim
