#include "LineWriter.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <ctime>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>
#include <csignal>

namespace Rabit
{
namespace
{

constexpr std::string_view Cut = " ... (cut)";

// At most PIPE_BUF bytes, the newline included.
class Line
{
public:
    // Adds the text, cut where it does not fit.
    void Add(std::string_view text)
    {
        const std::size_t room = _bytes.size() - 1 - _size;
        if (text.size() <= room)
        {
            Copy(text);
            return;
        }
        Copy(text.substr(0, room - std::min(room, Cut.size())));
        Copy(Cut.substr(0, _bytes.size() - 1 - _size));
    }
    void End() { _bytes[_size++] = '\n'; }

    const char *Data() const { return _bytes.data(); }
    std::size_t Size() const { return _size; }

private:
    void Copy(std::string_view text)
    {
        std::copy(text.begin(), text.end(), _bytes.data() + _size);
        _size += text.size();
    }

    std::array<char, PIPE_BUF> _bytes{};
    std::size_t _size = 0;
};

// Hides the SIGPIPE of this thread's writes from the program, which may not expect the signal.
class WithoutSigpipe
{
public:
    WithoutSigpipe()
    {
        sigset_t pending;
        sigpending(&pending);
        _wasPending = sigismember(&pending, SIGPIPE) == 1;
        sigemptyset(&_pipe);
        sigaddset(&_pipe, SIGPIPE);
        pthread_sigmask(SIG_BLOCK, &_pipe, &_before);
    }
    ~WithoutSigpipe()
    {
        const std::timespec now{};
        while (!_wasPending && sigtimedwait(&_pipe, nullptr, &now) < 0 && errno == EINTR)
        {
        }
        pthread_sigmask(SIG_SETMASK, &_before, nullptr);
    }
    WithoutSigpipe(const WithoutSigpipe &) = delete;
    WithoutSigpipe &operator=(const WithoutSigpipe &) = delete;

private:
    sigset_t _pipe{};
    sigset_t _before{};
    bool _wasPending = false;
};

bool IsWritable(int descriptor)
{
    pollfd asked{descriptor, POLLOUT, 0};
    return poll(&asked, 1, 0) == 1 && asked.revents == POLLOUT;
}

bool IsFile(int descriptor)
{
    struct stat status = {};
    return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

// A terminal can block in the middle of a line, even if poll(2) reported room. Only a terminal can be
// opened again: a pipe or socket has no name, and a file would be written from its beginning.
class OwnTerminal
{
public:
    explicit OwnTerminal(int descriptor)
    {
        if (isatty(descriptor) == 1)
        {
            const std::string name = "/proc/self/fd/" + std::to_string(descriptor);
            _own = open(name.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
        }
        _descriptor = _own >= 0 ? _own : descriptor;
    }
    ~OwnTerminal()
    {
        if (_own >= 0)
        {
            close(_own);
        }
    }
    OwnTerminal(const OwnTerminal &) = delete;
    OwnTerminal &operator=(const OwnTerminal &) = delete;

    int Descriptor() const { return _descriptor; }

private:
    int _own = -1;
    int _descriptor;
};

// One write(2). After poll(2) another process may have filled a pipe; RWF_NOWAIT covers that. Terminals do
// not know RWF_NOWAIT, and some file systems refuse it now and then.
ssize_t WriteOnce(int descriptor, const char *bytes, std::size_t size)
{
    iovec block{const_cast<char *>(bytes), size};
    const ssize_t written = pwritev2(descriptor, &block, 1, -1, RWF_NOWAIT);
    if (written >= 0 || (errno == EAGAIN && !IsFile(descriptor)))
    {
        return written;
    }
    return write(descriptor, bytes, size);
}

// Returns how many bytes were written.
std::size_t WriteWithoutWaiting(int shared, const Line &line)
{
    const WithoutSigpipe guard;
    const OwnTerminal own(shared);
    const int descriptor = own.Descriptor();
    std::size_t done = 0;
    while (done < line.Size() && IsWritable(descriptor))
    {
        const ssize_t written = WriteOnce(descriptor, line.Data() + done, line.Size() - done);
        if (written <= 0)
        {
            break;
        }
        done += static_cast<std::size_t>(written);
    }
    return done;
}

}  // namespace

void LineWriter::Write(std::string_view prefix, std::string_view text) noexcept
{
    const std::lock_guard<std::mutex> lock(_mutex);
    Line line;
    if (_isTorn)
    {
        line.Add("\n");
    }
    if (_lost > 0)
    {
        std::array<char, 100> notice{};
        std::snprintf(notice.data(), notice.size(), "rabit: warning: %llu %s not written: stderr was full\n",
                      static_cast<unsigned long long>(_lost), _lost == 1 ? "line was" : "lines were");
        line.Add(notice.data());
    }
    line.Add(prefix);
    line.Add(text);
    line.End();
    const std::size_t written = WriteWithoutWaiting(_descriptor, line);
    if (written == line.Size())
    {
        _lost = 0;
        _isTorn = false;
        return;
    }
    ++_lost;
    _isTorn = _isTorn || written > 0;
}

}  // namespace Rabit
