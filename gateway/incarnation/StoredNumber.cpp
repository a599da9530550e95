#include "incarnation/StoredNumber.h"

#include <fcntl.h>
#include <rabit/base/NumberIn.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace Rabit::StoredNumber
{
namespace
{

// A file descriptor that is closed at the end.
class SyncedFile
{
public:
    SyncedFile(const std::filesystem::path &path, int flags)
        : _descriptor(::open(path.c_str(), flags | O_CLOEXEC, 0644))
    {
    }
    ~SyncedFile()
    {
        if (_descriptor >= 0)
        {
            ::close(_descriptor);
        }
    }
    SyncedFile(const SyncedFile &) = delete;
    SyncedFile &operator=(const SyncedFile &) = delete;

    bool IsOpen() const { return _descriptor >= 0; }
    bool Write(const std::string &text) const
    {
        return ::write(_descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    }
    bool Sync() const { return ::fsync(_descriptor) == 0; }

private:
    int _descriptor;
};

std::string SystemError(const std::string &what, const std::filesystem::path &path)
{
    return what + ' ' + path.string() + ": " + std::generic_category().message(errno);
}

}  // namespace

std::uint64_t Read(const std::filesystem::path &file, std::uint64_t most, const std::string &what,
                   std::string &error)
{
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
    {
        return 0;
    }
    std::ifstream in(file);
    std::string text;
    if (!std::getline(in, text))
    {
        error = "cannot read the " + what + " from " + file.string();
        return 0;
    }
    const auto number = NumberIn<std::uint64_t>(text);
    if (!number || *number > most)
    {
        error = "no " + what + " in " + file.string() + ": '" + text.substr(0, 40) + "'";
        return 0;
    }
    return *number;
}

std::string Write(const std::filesystem::path &file, std::uint64_t number)
{
    const std::filesystem::path directory = file.parent_path();
    std::error_code problem;
    std::filesystem::create_directories(directory, problem);
    if (problem)
    {
        return "cannot make " + directory.string() + ": " + problem.message();
    }
    std::filesystem::path fresh = file;
    fresh += ".new";
    {
        const SyncedFile written(fresh, O_WRONLY | O_CREAT | O_TRUNC);
        if (!written.IsOpen() || !written.Write(std::to_string(number) + '\n') || !written.Sync())
        {
            return SystemError("cannot write", fresh);
        }
    }
    std::filesystem::rename(fresh, file, problem);
    if (problem)
    {
        return "cannot rename " + fresh.string() + ": " + problem.message();
    }
    const SyncedFile entry(directory, O_RDONLY | O_DIRECTORY);
    return entry.IsOpen() && entry.Sync() ? "" : SystemError("cannot sync", directory);
}

}  // namespace Rabit::StoredNumber
