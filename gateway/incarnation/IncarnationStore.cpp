#include "incarnation/IncarnationStore.h"

#include <fcntl.h>
#include <rabit/base/NumberIn.h>
#include <rabit/gateway/links/LinkMessages.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

namespace Rabit
{

namespace
{

// Above this, no higher incarnation could be taken.
constexpr std::uint32_t MaxCounter = std::numeric_limits<std::uint32_t>::max() - 1;
// In the year 2097: a wall clock that shows this or more would use up the counter.
constexpr std::int64_t FarthestSecond = std::int64_t{LinkLargestClaim};
constexpr std::int64_t NanosecondsInSecond = 1'000'000'000;

std::int64_t NanosecondsOfWallClock()
{
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

// The low half of an incarnation. 16 bits of the second are steps of 15 us: no process restarts faster.
std::uint32_t LowHalf(std::int64_t nanoseconds, std::uint64_t random)
{
    const std::int64_t fraction = (nanoseconds % NanosecondsInSecond << 16) / NanosecondsInSecond;
    return static_cast<std::uint32_t>(fraction << 16) | static_cast<std::uint32_t>(random >> 48);
}

std::string FileName(const std::string &node)
{
    constexpr char Digits[] = "0123456789abcdef";
    std::string name;
    for (const char c : node)
    {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           c == '.' || c == '-' || c == '_';
        if (plain)
        {
            name += c;
        }
        else
        {
            name += '%';
            name += Digits[byte >> 4];
            name += Digits[byte & 15];
        }
    }
    return name + ".incarnation";
}

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

IncarnationStore::IncarnationStore(const std::filesystem::path &stateDirectory, const std::string &node)
    : IncarnationStore(stateDirectory, node, NanosecondsOfWallClock)
{
}

IncarnationStore::IncarnationStore(const std::filesystem::path &stateDirectory, const std::string &node,
                                   WallClock wallClock, RandomSource random)
    : _file(stateDirectory.empty() ? std::filesystem::path() : stateDirectory / FileName(node)),
      _wallClock(std::move(wallClock)),
      _random(std::move(random))
{
}

std::uint64_t IncarnationStore::Above(std::uint64_t floor)
{
    const std::lock_guard lock(_mutex);
    if (!_isRead)
    {
        _isRead = true;
        _last = ReadCounter();
    }
    const auto known = std::max(_last, static_cast<std::uint32_t>(floor >> 32));
    const auto next = known < MaxCounter ? known + 1 : MaxCounter;
    const std::int64_t now = std::max<std::int64_t>(_wallClock(), 0);
    const std::int64_t seconds = now / NanosecondsInSecond;
    _last = seconds < FarthestSecond ? std::max(next, static_cast<std::uint32_t>(seconds)) : next;
    _unsaved = !_file.empty();
    return (static_cast<std::uint64_t>(_last) << 32) | LowHalf(now, _random());
}

void IncarnationStore::Save()
{
    if (!_unsaved)
    {
        return;
    }
    std::uint32_t counter = 0;
    {
        const std::lock_guard lock(_mutex);
        counter = _last;
        _unsaved = false;
    }
    const std::string error = Write(counter);
    const std::lock_guard lock(_mutex);
    const std::string readError = std::exchange(_readError, "");
    _error = error.empty() ? readError : error;
}

std::string IncarnationStore::Error() const
{
    const std::lock_guard lock(_mutex);
    return _error;
}

// Returns 0 if there is no file, or no counter in it.
std::uint32_t IncarnationStore::ReadCounter()
{
    std::error_code ignored;
    if (_file.empty() || !std::filesystem::exists(_file, ignored))
    {
        return 0;
    }
    std::ifstream in(_file);
    std::string text;
    if (!std::getline(in, text))
    {
        _readError = "cannot read the incarnation from " + _file.string();
        return 0;
    }
    const auto counter = NumberIn<std::uint32_t>(text);
    if (!counter)
    {
        _readError = "no incarnation in " + _file.string() + ": '" + text.substr(0, 40) + "'";
    }
    return counter.value_or(0);
}

// Writes a new file beside the old one and renames it, so that the disk holds one whole file at any moment.
// Returns the failure in one line, or an empty text.
std::string IncarnationStore::Write(std::uint32_t counter) const
{
    const std::filesystem::path directory = _file.parent_path();
    std::error_code problem;
    std::filesystem::create_directories(directory, problem);
    if (problem)
    {
        return "cannot make " + directory.string() + ": " + problem.message();
    }
    std::filesystem::path fresh = _file;
    fresh += ".new";
    {
        const SyncedFile file(fresh, O_WRONLY | O_CREAT | O_TRUNC);
        if (!file.IsOpen() || !file.Write(std::to_string(counter) + '\n') || !file.Sync())
        {
            return SystemError("cannot write", fresh);
        }
    }
    std::filesystem::rename(fresh, _file, problem);
    if (problem)
    {
        return "cannot rename " + fresh.string() + ": " + problem.message();
    }
    const SyncedFile entry(directory, O_RDONLY | O_DIRECTORY);
    return entry.IsOpen() && entry.Sync() ? "" : SystemError("cannot sync", directory);
}

}  // namespace Rabit
