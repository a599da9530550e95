// Runs idlc with the generator plugin, as the build does.
#pragma once

#include <filesystem>
#include <string>

// Set by CMake.
namespace Paths
{
extern const char *const Idlc;
extern const char *const Plugin;
extern const char *const Messages;
extern const char *const Refused;
extern const char *const Compiler;
extern const char *const IncludeOptions;  // of the compiler, for the headers of generated code
extern const char *const RosIdl;
extern const char *const RosPackages;
extern const char *const Px4Messages;
}  // namespace Paths

struct IdlcResult
{
    int ExitCode = 0;
    std::string Errors;  // what it wrote to its standard error output
};

// Output goes to the directory.
IdlcResult RunIdlc(const std::filesystem::path &idl, const std::filesystem::path &output);
std::string ReadFile(const std::filesystem::path &path);
// An empty directory that is removed in the end.
class ScratchDirectory
{
public:
    ScratchDirectory();
    ~ScratchDirectory();
    ScratchDirectory(const ScratchDirectory &) = delete;
    ScratchDirectory &operator=(const ScratchDirectory &) = delete;
    const std::filesystem::path &Path() const { return _path; }

private:
    std::filesystem::path _path;
};
