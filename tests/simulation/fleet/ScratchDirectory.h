#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

namespace Rabit::Sim
{

// A directory that is removed with its contents.
class ScratchDirectory
{
public:
    explicit ScratchDirectory(std::uint64_t seed)
        : _path(std::filesystem::temp_directory_path() /
                ("rabit_fleet_simulation." + std::to_string(::getpid()) + "." + std::to_string(seed)))
    {
    }
    ~ScratchDirectory()
    {
        std::error_code ignored;
        std::filesystem::remove_all(_path, ignored);
    }
    ScratchDirectory(const ScratchDirectory &) = delete;
    ScratchDirectory &operator=(const ScratchDirectory &) = delete;
    const std::filesystem::path &Path() const { return _path; }

private:
    std::filesystem::path _path;
};

}  // namespace Rabit::Sim
