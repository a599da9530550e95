#include "InputLines.h"

#include <array>
#include <stdexcept>
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
    if (!_input.IsOpen())
    {
        throw std::runtime_error("standard input cannot be read: no pipe can be made");
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
    _input.Stop();
    _reader.join();
}

void InputLines::Read()
{
    std::string text;
    std::array<char, 4096> buffer;
    while (const std::size_t count = _input.Read(buffer))
    {
        text.append(buffer.data(), count);
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
