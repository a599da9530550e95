// Runs the queue links on a simulated network, over many seeds.
//
//   link_simulation --seeds 20000 [--first 1] [--jobs 2] [--require-coverage]
//   link_simulation --seed 4711 [--trace]
//
// Prints what happened in total. On a violation: the seed, the commit and the last events, and exit status 1.
#include "LinkSimulation.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <iostream>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace Rabit::Sim
{

namespace
{

constexpr std::size_t EventsShown = 60;

struct Arguments
{
    std::uint64_t First = 1;
    std::uint64_t Seeds = 1;
    unsigned Jobs = 2;
    bool Trace = false;
    bool RequireCoverage = false;
};

[[noreturn]] void Usage(const std::string &problem)
{
    std::cerr << problem
              << "\nusage: link_simulation (--seeds COUNT [--first SEED] [--jobs N] [--require-coverage] "
              << "| --seed SEED [--trace])\n";
    std::exit(2);
}

Arguments Parse(int argc, char **argv)
{
    Arguments arguments;
    for (int i = 1; i < argc; ++i)
    {
        const std::string_view name = argv[i];
        const auto number = [&]() -> std::uint64_t
        {
            char *end = nullptr;
            const std::uint64_t value = i + 1 < argc ? std::strtoull(argv[++i], &end, 10) : 0;
            if (end == nullptr || *end != '\0')
            {
                Usage(std::string(name) + " needs a number");
            }
            return value;
        };
        if (name == "--seeds")
        {
            arguments.Seeds = number();
        }
        else if (name == "--first" || name == "--seed")
        {
            arguments.First = number();
        }
        else if (name == "--jobs")
        {
            arguments.Jobs = static_cast<unsigned>(number());
        }
        else if (name == "--trace")
        {
            arguments.Trace = true;
        }
        else if (name == "--require-coverage")
        {
            arguments.RequireCoverage = true;
        }
        else
        {
            Usage("unknown argument " + std::string(name));
        }
    }
    return arguments;
}

// The commit that the sources are at now; for the report of a failure alone.
std::string Commit()
{
    const std::string command =
        std::string("git -C '") + RABIT_SOURCE_DIR + "' describe --always --dirty 2>/dev/null";
    const std::unique_ptr<FILE, int (*)(FILE *)> pipe(::popen(command.c_str(), "r"), ::pclose);
    std::array<char, 100> text{};
    if (!pipe || std::fgets(text.data(), static_cast<int>(text.size()), pipe.get()) == nullptr)
    {
        return "unknown";
    }
    std::string commit(text.data());
    while (!commit.empty() && commit.back() == '\n')
    {
        commit.pop_back();
    }
    return commit;
}

void ReportFailure(std::uint64_t seed, const std::string &failure)
{
    std::stringstream trace;
    const SimResult again = RunSeed(seed, &trace);
    std::deque<std::string> last;
    for (std::string line; std::getline(trace, line);)
    {
        last.push_back(line);
        if (last.size() > EventsShown)
        {
            last.pop_front();
        }
    }
    std::cout << "FAILED seed " << seed << ", commit " << Commit() << "\n" << failure << "\n";
    std::cout << (again.Failure == failure
                      ? "The last events (replayed exactly):\n"
                      : "The replay differs, the run is not deterministic! Its last events:\n");
    for (const std::string &line : last)
    {
        std::cout << "  " << line << '\n';
    }
    std::cout << "Replay: link_simulation --seed " << seed << " --trace" << std::endl;
}

// Runs all seeds on several threads. Returns false after a violation.
bool RunSeeds(const Arguments &arguments, SimStatistics &total)
{
    std::atomic<std::uint64_t> next{arguments.First};
    std::atomic<bool> failed{false};
    std::mutex mutex;
    const auto work = [&]
    {
        SimStatistics mine;
        for (;;)
        {
            const std::uint64_t seed = next.fetch_add(1);
            if (seed >= arguments.First + arguments.Seeds || failed)
            {
                break;
            }
            const SimResult result = RunSeed(seed, nullptr);
            mine.Add(result.Statistics);
            if (!result.Failure.empty() && !failed.exchange(true))
            {
                const std::lock_guard lock(mutex);
                ReportFailure(seed, result.Failure);
            }
        }
        const std::lock_guard lock(mutex);
        total.Add(mine);
    };
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < arguments.Jobs; ++i)
    {
        threads.emplace_back(work);
    }
    for (std::thread &thread : threads)
    {
        thread.join();
    }
    return !failed;
}

struct Figure
{
    const char *Name;
    std::uint64_t Value;
};

// Prints the totals. Returns false if something that the simulation is meant to try never happened.
bool PrintTotals(const SimStatistics &total)
{
    const std::array<Figure, 16> figures{{{"events", total.Events},
                                          {"messages accepted", total.Accepted},
                                          {"refused (full)", total.Refused},
                                          {"delivered", total.Delivered},
                                          {"expired", total.Expired},
                                          {"in doubt", total.InDoubt},
                                          {"refused there", total.RefusedThere},
                                          {"delivered again (opted in)", total.DeliveredAgain},
                                          {"datagrams", total.Datagrams},
                                          {"datagrams lost", total.Lost},
                                          {"datagrams duplicated", total.Duplicated},
                                          {"datagrams straggling", total.Straggling},
                                          {"malformed datagrams", total.Malformed},
                                          {"crashes", total.Crashes},
                                          {"storages lost", total.StoragesLost},
                                          {"incarnations raised", total.Raises}}};
    bool complete = true;
    for (const Figure &figure : figures)
    {
        std::cout << "  " << figure.Name << ": " << figure.Value << '\n';
        complete = complete && figure.Value > 0;
    }
    std::cout << "  longest drain: " << static_cast<double>(total.LongestDrain.count()) / 1e9 << " s\n";
    return complete;
}

int Main(int argc, char **argv)
{
    const Arguments arguments = Parse(argc, argv);
    SimStatistics total;
    const auto start = std::chrono::steady_clock::now();
    bool good = false;
    if (arguments.Trace)
    {
        const SimResult result = RunSeed(arguments.First, &std::cout);
        total = result.Statistics;
        good = result.Failure.empty();
        std::cout << (good ? "no violation" : result.Failure) << '\n';
    }
    else
    {
        good = RunSeeds(arguments, total);
    }
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    std::cout << arguments.Seeds << " seeds from " << arguments.First << " in " << passed.count() << " s\n";
    if (!PrintTotals(total) && arguments.RequireCoverage && good)
    {
        std::cout << "FAILED: something of the above never happened\n";
        good = false;
    }
    return good ? 0 : 1;
}

}  // namespace

}  // namespace Rabit::Sim

int main(int argc, char **argv)
{
    return Rabit::Sim::Main(argc, argv);
}
