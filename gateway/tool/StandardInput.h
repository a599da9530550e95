#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace Rabit::Tool
{

// Standard input, for a thread that reads it until it is stopped. No such thread may wait inside std::cin: it
// would hold the lock of standard input, for which glibc waits when a process ends (2.41, Debian 13).
class StandardInput
{
public:
    StandardInput();
    ~StandardInput();
    StandardInput(const StandardInput &) = delete;
    StandardInput &operator=(const StandardInput &) = delete;

    // False if no pipe could be made: nothing can be read.
    bool IsOpen() const { return _stop[0] >= 0; }
    // Waits for bytes, and returns how many were read. 0: the input has ended, or Stop was called. On one
    // thread at a time.
    std::size_t Read(std::span<char> to);
    // Ends Read, now and from now on. Any thread, once.
    void Stop();

private:
    std::array<int, 2> _stop{-1, -1};  // a pipe, whose writing end is closed by Stop
};

}  // namespace Rabit::Tool
