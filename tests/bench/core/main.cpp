// Runs the benchmarks of the core and compares them with their aims; see ../README.md.
#include "AimsTable.h"

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

int main(int argc, char **argv)
{
    // Defaults that the command line may override: later arguments win.
    std::vector<std::string> arguments{argv[0],
                                       "--benchmark_out=bench_core.json",
                                       "--benchmark_out_format=json",
                                       "--benchmark_repetitions=5",
                                       "--benchmark_min_time=0.2",
                                       "--benchmark_enable_random_interleaving=true"};
    arguments.insert(arguments.end(), argv + 1, argv + argc);
    std::vector<char *> pointers;
    for (std::string &argument : arguments)
    {
        pointers.push_back(argument.data());
    }
    int count = static_cast<int>(pointers.size());
    benchmark::Initialize(&count, pointers.data());
    if (benchmark::ReportUnrecognizedArguments(count, pointers.data()))
    {
        return 2;
    }
    AimsTable table;
    benchmark::RunSpecifiedBenchmarks(&table);
    benchmark::Shutdown();
    table.Print();
    return 0;
}
