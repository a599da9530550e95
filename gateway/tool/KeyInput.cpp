#include "KeyInput.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace Rabit::Tool
{
namespace
{

// Keys kept until Take; later ones are dropped.
constexpr std::size_t MostKeys = 100;

}  // namespace

KeyInput::KeyInput(std::function<void()> onKey) : _onKey(std::move(onKey))
{
    if (::isatty(STDIN_FILENO) == 0 || ::tcgetpgrp(STDIN_FILENO) != ::getpgrp() ||
        ::tcgetattr(STDIN_FILENO, &_before) != 0 || ::pipe(_end.data()) != 0)
    {
        return;
    }
    termios keys = _before;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    keys.c_cc[VMIN] = 1;
    keys.c_cc[VTIME] = 0;
    ::tcsetattr(STDIN_FILENO, TCSANOW, &keys);
    _reader = std::thread([this] { Read(); });
}

KeyInput::~KeyInput()
{
    if (_reader.joinable())
    {
        ::close(_end[1]);
        _reader.join();
        ::close(_end[0]);
        ::tcsetattr(STDIN_FILENO, TCSANOW, &_before);
    }
}

std::optional<char> KeyInput::Take()
{
    const std::lock_guard lock(_mutex);
    if (_keys.empty())
    {
        return std::nullopt;
    }
    const char key = _keys.front();
    _keys.pop_front();
    return key;
}

void KeyInput::Read()
{
    for (;;)
    {
        std::array<pollfd, 2> files{{{STDIN_FILENO, POLLIN, 0}, {_end[0], POLLIN, 0}}};
        const int ready = ::poll(files.data(), files.size(), -1);
        if (ready < 0 && errno == EINTR)
        {
            continue;
        }
        char key = 0;
        if (ready < 0 || files[1].revents != 0 || ::read(STDIN_FILENO, &key, 1) != 1)
        {
            return;
        }
        {
            const std::lock_guard lock(_mutex);
            if (_keys.size() < MostKeys)
            {
                _keys.push_back(key);
            }
        }
        _onKey();
    }
}

}  // namespace Rabit::Tool
