#include "StandardInput.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace Rabit::Tool
{

StandardInput::StandardInput()
{
    if (::pipe(_stop.data()) != 0)
    {
        _stop = {-1, -1};
    }
}

StandardInput::~StandardInput()
{
    Stop();
    if (IsOpen())
    {
        ::close(_stop[0]);
    }
}

std::size_t StandardInput::Read(std::span<char> to)
{
    while (IsOpen())
    {
        std::array<pollfd, 2> files{{{STDIN_FILENO, POLLIN, 0}, {_stop[0], POLLIN, 0}}};
        const int ready = ::poll(files.data(), files.size(), -1);
        if (ready < 0 && errno == EINTR)
        {
            continue;
        }
        if (ready < 0 || files[1].revents != 0)
        {
            return 0;
        }
        const ssize_t count = ::read(STDIN_FILENO, to.data(), to.size());
        if (count < 0 && (errno == EINTR || errno == EAGAIN))
        {
            continue;
        }
        return count < 0 ? 0 : static_cast<std::size_t>(count);
    }
    return 0;
}

void StandardInput::Stop()
{
    if (const int end = std::exchange(_stop[1], -1); end >= 0)
    {
        ::close(end);
    }
}

}  // namespace Rabit::Tool
