#include "RunIdlc.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

namespace fs = std::filesystem;

IdlcResult RunIdlc(const fs::path &idl, const fs::path &output)
{
    const fs::path log = output / "errors.log";
    const std::string command =
        std::string("'") + Paths::Idlc + "' -W no-implicit-extensibility -W no-enum-consecutive -l '" +
        Paths::Plugin + "' -o '" + output.string() + "' '" + idl.string() + "' 2>'" + log.string() + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadFile(log)};
}

std::string ReadFile(const fs::path &path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

ScratchDirectory::ScratchDirectory()
{
    std::string name = (fs::temp_directory_path() / "rabit_idl_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
    {
        throw std::runtime_error("cannot make a directory like " + name);
    }
    _path = name;
}

ScratchDirectory::~ScratchDirectory()
{
    std::error_code ignored;
    fs::remove_all(_path, ignored);
}
