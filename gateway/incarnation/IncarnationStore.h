#pragma once

#include <rabit/gateway/RandomSource.h>
#include <rabit/gateway/links/LinkHost.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>

namespace Rabit
{

// The incarnations of one node. The high 32 bits are a counter that rises at every start. The next 16 are the
// fraction of the wall clock's second, and the last 16 are random. The counter is kept in a small file, which
// is written and synced before anybody else is told the incarnation.
//
// The counter never falls below the wall clock's seconds since 1970. A clock that shows 2097 or later is not
// believed. So the loss of the file is harmless as long as the wall clock is right. Without a file the wall
// clock is all there is: incarnations then rise from start to start by the fraction, within one second too.
//
// Without a file, a wall clock that was set back between two starts gives a lower incarnation. Peers accept
// it at once after a goodbye, otherwise once the former incarnation is STALE (PeerTable). The links do not
// wait: peers that remember a higher incarnation make the node take one above it (rules R1 and S6 of the
// links).
//
// Giving out a number and storing it are two calls, because a disk may take seconds to sync: Above is called
// under the lock of the links, Save is not.
//
// Nothing here throws and nothing stops the node: Error() tells a failure of the file, and the incarnation is
// then made from the wall clock. Thread-safe.
class IncarnationStore : public IncarnationSource
{
public:
    // Nanoseconds since 1970 by the wall clock. Replaced in tests.
    using WallClock = std::function<std::int64_t()>;

    // Keeps the counter in `<stateDirectory>/<node>.incarnation`; characters of the name other than letters,
    // digits, `.`, `-` and `_` are written as `%` and two hexadecimal digits. The directory is made if it
    // does not exist. An empty directory means: no file.
    IncarnationStore(const std::filesystem::path &stateDirectory, const std::string &node);
    IncarnationStore(const std::filesystem::path &stateDirectory, const std::string &node,
                     WallClock wallClock, RandomSource random = SystemRandom);

    // Returns an incarnation above all that this object gave out, above `floor`, and above the stored one:
    // the first call reads the file. Save must return before anybody is told of it.
    std::uint64_t Above(std::uint64_t floor) override;

    // Stores the counter that Above has given out since the last call; may take as long as the disk does.
    // Costs next to nothing if there is nothing to store. A failed write is not repeated before the next
    // incarnation.
    void Save();

    // The failure of the last read or write of the file, in one line; empty if both succeeded. A file that
    // does not exist yet is no failure.
    std::string Error() const;
    // The file; empty if there is none.
    const std::filesystem::path &File() const { return _file; }

private:
    std::uint32_t ReadCounter();

    const std::filesystem::path _file;
    const WallClock _wallClock;
    const RandomSource _random;
    mutable std::mutex _mutex;  // not held while the file is written
    bool _isRead = false;
    std::uint32_t _last = 0;  // until it is told by _error once
    std::string _readError;   // until it is told by _error once
    std::string _error;
    std::atomic<bool> _unsaved{false};  // changed under the mutex
};

}  // namespace Rabit
