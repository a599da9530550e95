#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string_view>

namespace Rabit
{

// Writes lines to a file descriptor that other processes may share, and never waits for its reader. A line
// that does not fit is dropped and counted, and the count precedes the next line that is written.
// Thread-safe.
//
// Each line is one write(2) of at most PIPE_BUF bytes, so lines of several threads and processes do not
// mix. A longer line is cut, and marked at its end.
//
// A full pipe or socket, a stopped terminal, a full disk and a closed descriptor never block the caller or
// raise SIGPIPE. O_NONBLOCK is not set: it would apply to all processes that share the descriptor. Three
// limits remain:
// - A file on a network disk that hangs blocks the caller.
// - A kernel without RWF_NOWAIT for pipes (before 6.4) blocks if another process fills the pipe between
// poll(2)
//   and write(2).
// - A terminal that this process may not open (another user's) blocks if the last line fits in part.
class LineWriter
{
public:
    explicit LineWriter(int descriptor) : _descriptor(descriptor) {}

    // Writes `prefix`, `text` and a newline.
    void Write(std::string_view prefix, std::string_view text) noexcept;

private:
    const int _descriptor;
    std::mutex _mutex;
    std::uint64_t _lost = 0;  // lines since the last one that was written
    bool _isTorn = false;     // the last line ended before its newline
};

}  // namespace Rabit
