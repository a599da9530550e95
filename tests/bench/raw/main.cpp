// A program of a user who calls DDS by hand, for one vendor: the roles of the benchmarks.
#include "RawRoles.h"

#include <exception>
#include <iostream>

int main(int argc, char **argv)
{
    const Rabit::Bench::BenchOptions options =
        Rabit::Bench::ParseOptions(argc, argv, "A plain DDS program, the contestant of the gateway.");
    try
    {
        return Rabit::Bench::RunRawRole(options);
    }
    catch (const std::exception &error)
    {
        std::cerr << "raw: " << error.what() << '\n';
        return 1;
    }
}
