#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace Rabit::Tool
{

// The lines of standard input, read on a thread of their own, so that waiting for a line can end with Ctrl-C.
// A read that is under way when the object is destroyed goes on until the process ends.
class InputLines
{
public:
    // `onLine` is called on that thread when a line or the end has come, and never after the object is
    // destroyed.
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
    struct State;
    const std::shared_ptr<State> _state;
};

}  // namespace Rabit::Tool
