#pragma once

#include <rabit/gateway/RandomSource.h>
#include <rabit/gateway/links/LinkHost.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace Rabit
{

// The incarnations of one node: a counter in the high 32 bits that rises at every start, and a random number
// in the low 32. The counter is kept in a small file, which is written and synced before the incarnation is
// used.
//
// The counter never falls below the wall clock's seconds since 1970 if the clock is ahead of it. So the loss
// of the file is harmless as long as the wall clock is right; without a file the seconds are all there is. If
// both are wrong, peers that remember a higher incarnation make the node take one above it (rules R1 and S6
// of the links).
//
// Nothing here throws and nothing stops the node: what goes wrong with the file is told by Error(), and the
// incarnation is then made from the wall clock. Not thread-safe.
class IncarnationStore : public IncarnationSource
{
public:
    // Seconds since 1970 by the wall clock. Replaced in tests.
    using WallClock = std::function<std::int64_t()>;

    // Keeps the counter in `<stateDirectory>/<node>.incarnation`; characters of the name other than letters,
    // digits, `.`, `-` and `_` are written as `%` and two hexadecimal digits. The directory is made if it
    // does not exist. An empty directory means: no file.
    IncarnationStore(const std::filesystem::path &stateDirectory, const std::string &node);
    IncarnationStore(const std::filesystem::path &stateDirectory, const std::string &node,
                     WallClock wallClock, RandomSource random = SystemRandom);

    // An incarnation above the stored one and above `floor`, stored before this returns if there is a file.
    std::uint64_t Above(std::uint64_t floor) override;

    // What went wrong with the file at the last call of Above, in one line; empty if nothing did (a file that
    // does not exist yet is not an error).
    const std::string &Error() const { return _error; }
    // The file; empty if there is none.
    const std::filesystem::path &File() const { return _file; }

private:
    std::uint32_t ReadCounter();
    void WriteCounter(std::uint32_t counter);

    std::filesystem::path _file;
    WallClock _wallClock;
    RandomSource _random;
    std::uint32_t _last = 0;  // the counter of this process's latest incarnation
    std::string _error;
};

}  // namespace Rabit
