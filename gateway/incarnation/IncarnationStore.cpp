#include "incarnation/IncarnationStore.h"

#include <rabit/gateway/links/LinkMessages.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "incarnation/StoredNumber.h"

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
    const std::string error = StoredNumber::Write(_file, counter);
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
    return _file.empty() ? 0
                         : static_cast<std::uint32_t>(StoredNumber::Read(
                               _file, std::numeric_limits<std::uint32_t>::max(), "incarnation", _readError));
}

}  // namespace Rabit
