#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "StandardInput.h"

namespace Rabit::Tool
{

// The lines of standard input, read on a thread of their own, so that waiting for a line can end with Ctrl-C.
// The thread ends with the object.
class InputLines
{
public:
    // `onLine` is called on that thread when a line or the end has come, and never after the object is
    // destroyed. Throws std::runtime_error if standard input cannot be read.
    explicit InputLines(std::function<void()> onLine);
    ~InputLines();
    InputLines(const InputLines &) = delete;
    InputLines &operator=(const InputLines &) = delete;

    struct Line
    {
        std::optional<std::string> Text;  // empty: the end
    };
    // Returns true if there is a line, or the end.
    bool Take(Line &line);

private:
    void Read();
    // Empty: the end of the input. Returns false if the thread should end.
    bool Add(std::optional<std::string> line);

    const std::function<void()> _onLine;
    StandardInput _input;
    std::mutex _mutex;  // guards the next three
    std::deque<std::string> _lines;
    bool _isOver = false;
    bool _isEnding = false;
    std::condition_variable _changed;
    std::thread _reader;  // last: it uses the others
};

}  // namespace Rabit::Tool
