#pragma once

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace Rabit
{

// One expectation of a scenario, and the observation that decided it.
struct LabVerdict
{
    bool IsMet = false;
    std::string Expected;
    std::string Seen;
};

// The result of a scenario. True if every expectation was met.
struct LabResult
{
    int ExitCode = 0;  // of `rabit lab`: 0 passed, 1 failed, 2 wrong scenario, 3 not possible on this machine
    std::string Folder;  // with report.html
    std::vector<LabVerdict> Verdicts{};

    explicit operator bool() const { return ExitCode == 0; }
    // True if this machine allows no namespaces, so that a test should be skipped.
    bool IsImpossible() const { return ExitCode == 3; }
};

// Prints the expectations that were not met, and where the report is.
inline std::ostream &operator<<(std::ostream &stream, const LabResult &result)
{
    for (const LabVerdict &verdict : result.Verdicts)
    {
        if (!verdict.IsMet)
        {
            stream << "not met: " << verdict.Expected << ": " << verdict.Seen << '\n';
        }
    }
    return stream << "exit code " << result.ExitCode << "; " << result.Folder << "/report.html\n";
}

// Runs scenarios of `rabit lab` from a test, in real time:
//
//     const Rabit::LabResult flight = Rabit::Lab().Run("flight.yaml", "results/flight");
//     EXPECT_TRUE(flight) << flight;
class Lab
{
public:
    // `program`: the program `rabit`, by its path or found in PATH.
    explicit Lab(std::string program = "rabit") : _program(std::move(program)) {}

    // Runs a scenario to its end. Its results go to `folder`, which must be empty or not there. The progress
    // goes to the standard output. Throws std::system_error if the program cannot be started, and
    // std::runtime_error if a signal ended it.
    LabResult Run(const std::string &scenario, const std::string &folder) const
    {
        std::vector<std::string> words = {_program, "lab", "run", scenario, "--to", folder};
        std::vector<char *> arguments;
        for (std::string &word : words)
        {
            arguments.push_back(word.data());
        }
        arguments.push_back(nullptr);
        pid_t child = 0;
        const int failed =
            posix_spawnp(&child, _program.c_str(), nullptr, nullptr, arguments.data(), environ);
        if (failed != 0)
        {
            throw std::system_error(failed, std::generic_category(), _program);
        }
        int status = 0;
        while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        {
        }
        if (!WIFEXITED(status))
        {
            throw std::runtime_error(_program + " lab was ended by a signal");
        }
        LabResult result{WEXITSTATUS(status), folder};
        std::ifstream file(folder + "/verdicts.txt");
        for (std::string line; std::getline(file, line);)
        {
            result.Verdicts.push_back(VerdictOf(line));
        }
        return result;
    }

private:
    // `met` or `not met`, what was expected, and what was seen, with tabs in between.
    static LabVerdict VerdictOf(const std::string &line)
    {
        const std::size_t first = line.find('\t');
        const std::size_t second = line.find('\t', first == std::string::npos ? first : first + 1);
        if (second == std::string::npos)
        {
            return {false, line, ""};
        }
        return {line.substr(0, first) == "met", line.substr(first + 1, second - first - 1),
                line.substr(second + 1)};
    }

    std::string _program;
};

}  // namespace Rabit
