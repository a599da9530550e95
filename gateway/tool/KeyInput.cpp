#include "KeyInput.h"

#include <unistd.h>

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
        ::tcgetattr(STDIN_FILENO, &_before) != 0 || !_input.IsOpen())
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
        _input.Stop();
        _reader.join();
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
    char key = 0;
    while (_input.Read({&key, 1}) == 1)
    {
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
