#include "InputLines.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace Rabit::Tool
{
namespace
{

// Lines kept; beyond, the reading thread waits until one is taken.
constexpr std::size_t MostLines = 1000;

}  // namespace

InputLines::InputLines(std::function<void()> onLine) : _onLine(std::move(onLine))
{
    if (::pipe(_end.data()) != 0)
    {
        throw std::system_error(errno, std::generic_category(), "standard input cannot be read");
    }
    _reader = std::thread([this] { Read(); });
}

InputLines::~InputLines()
{
    {
        const std::lock_guard lock(_mutex);
        _isEnding = true;
    }
    _changed.notify_all();
    ::close(_end[1]);
    _reader.join();
    ::close(_end[0]);
}

void InputLines::Read()
{
    std::string text;
    for (;;)
    {
        std::array<pollfd, 2> files{{{STDIN_FILENO, POLLIN, 0}, {_end[0], POLLIN, 0}}};
        const int ready = ::poll(files.data(), files.size(), -1);
        if (ready < 0 && errno == EINTR)
        {
            continue;
        }
        if (ready < 0 || files[1].revents != 0)
        {
            break;
        }
        std::array<char, 4096> buffer;
        const ssize_t count = ::read(STDIN_FILENO, buffer.data(), buffer.size());
        if (count < 0 && (errno == EINTR || errno == EAGAIN))
        {
            continue;
        }
        if (count <= 0)
        {
            break;
        }
        text.append(buffer.data(), static_cast<std::size_t>(count));
        std::size_t begin = 0;
        for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
        {
            if (!Add(text.substr(begin, end - begin)))
            {
                return;
            }
        }
        text.erase(0, begin);
    }
    if (text.empty() || Add(std::move(text)))
    {
        Add(std::nullopt);
    }
}

bool InputLines::Add(std::optional<std::string> line)
{
    {
        std::unique_lock lock(_mutex);
        _changed.wait(lock, [this] { return _lines.size() < MostLines || _isEnding; });
        if (_isEnding)
        {
            return false;
        }
        if (line)
        {
            _lines.push_back(std::move(*line));
        }
        else
        {
            _isOver = true;
        }
    }
    _onLine();
    return true;
}

bool InputLines::Take(Line &line)
{
    {
        const std::lock_guard lock(_mutex);
        if (_lines.empty())
        {
            line.Text.reset();
            return _isOver;
        }
        line.Text = std::move(_lines.front());
        _lines.pop_front();
    }
    _changed.notify_all();
    return true;
}

}  // namespace Rabit::Tool
