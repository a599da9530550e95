#include "SeedRunner.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <deque>
#include <exception>
#include <iostream>
#include <memory>
#include <mutex>
#include <sstream>
#include <thread>

namespace Paths
{
extern const char *const SourceFolder;
}

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

// Returns the commit of the sources, for the report of a failure alone.
std::string Commit()
{
    const std::string command =
        std::string("git -C '") + Paths::SourceFolder + "' describe --always --dirty 2>/dev/null";
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

// An exception that leaves a run is a failure like any other.
SeedResult RunGuarded(const SeedFunction &run, std::uint64_t seed, std::ostream *trace)
{
    try
    {
        return run(seed, trace);
    }
    catch (const std::exception &error)
    {
        return {std::string("exception: ") + error.what(), {}};
    }
}

void ReportFailure(const char *program, const SeedFunction &run, std::uint64_t seed,
                   const std::string &failure)
{
    std::stringstream trace;
    const SeedResult again = RunGuarded(run, seed, &trace);
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
    std::cout << "Replay: " << program << " --seed " << seed << " --trace" << std::endl;
}

class Totals
{
public:
    void Add(const std::vector<Figure> &figures, std::uint64_t seed)
    {
        if (_figures.empty())
        {
            _figures = figures;
            _seeds.assign(figures.size(), seed);
            return;
        }
        for (std::size_t i = 0; i < figures.size(); ++i)
        {
            std::uint64_t &total = _figures[i].Value;
            if (figures[i].How == Figure::Kind::Sum)
            {
                total += figures[i].Value;
            }
            else if (figures[i].Value > total)
            {
                total = figures[i].Value;
                _seeds[i] = seed;
            }
        }
    }

    // Prints the totals. Returns false if something that the simulation is meant to try never happened.
    bool Print() const
    {
        bool complete = !_figures.empty();
        for (std::size_t i = 0; i < _figures.size(); ++i)
        {
            const Figure &figure = _figures[i];
            std::cout << "  " << figure.Name << ": ";
            if (figure.How == Figure::Kind::Sum)
            {
                std::cout << figure.Value << '\n';
                complete = complete && figure.Value > 0;
            }
            else
            {
                figure.How == Figure::Kind::Largest
                    ? std::cout << static_cast<double>(figure.Value) / 1e9 << " s"
                    : std::cout << figure.Value << " %";
                std::cout << ", seed " << _seeds[i] << '\n';
            }
        }
        return complete;
    }

private:
    std::vector<Figure> _figures;
    std::vector<std::uint64_t> _seeds;  // of the largest values
};

// Runs all seeds on several threads. Returns false after a violation.
bool RunAll(const char *program, const Arguments &arguments, const SeedFunction &run, Totals &totals)
{
    std::atomic<std::uint64_t> next{arguments.First};
    std::atomic<bool> failed{false};
    std::mutex mutex;
    const auto work = [&]
    {
        for (;;)
        {
            const std::uint64_t seed = next.fetch_add(1);
            if (seed >= arguments.First + arguments.Seeds || failed)
            {
                return;
            }
            const SeedResult result = RunGuarded(run, seed, nullptr);
            const std::lock_guard lock(mutex);
            totals.Add(result.Figures, seed);
            if (!result.Failure.empty() && !failed.exchange(true))
            {
                ReportFailure(program, run, seed, result.Failure);
            }
        }
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

}  // namespace

int RunSeeds(const char *program, int argc, char **argv, const SeedFunction &run)
{
    Arguments arguments;
    CLI::App app("One seed decides everything in a run of this simulation.", program);
    app.add_option("--seeds", arguments.Seeds, "how many seeds to run");
    app.add_option("--first,--seed", arguments.First, "the first seed, or the only one");
    app.add_option("--jobs", arguments.Jobs, "threads")->check(CLI::Range(1, 1000));
    app.add_flag("--trace", arguments.Trace, "run one seed and print its events");
    app.add_flag("--require-coverage", arguments.RequireCoverage, "fail if something never happened");
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError &error)
    {
        return app.exit(error) == 0 ? 0 : 2;
    }

    Totals totals;
    const auto start = std::chrono::steady_clock::now();
    bool good = false;
    if (arguments.Trace)
    {
        const SeedResult result = RunGuarded(run, arguments.First, &std::cout);
        totals.Add(result.Figures, arguments.First);
        good = result.Failure.empty();
        std::cout << (good ? "no violation" : result.Failure) << '\n';
    }
    else
    {
        good = RunAll(program, arguments, run, totals);
    }
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    std::cout << arguments.Seeds << " seeds from " << arguments.First << " in " << passed.count() << " s\n";
    if (!totals.Print() && arguments.RequireCoverage && good)
    {
        std::cout << "FAILED: something of the above never happened\n";
        good = false;
    }
    return good ? 0 : 1;
}

}  // namespace Rabit::Sim
