#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace Rabit::Tool
{

// The lines of standard input, read on a thread of their own, so that who waits for one can also wait for
// Ctrl-C. A read that is under way when the object goes is left to the end of the process.
class InputLines
{
public:
    // `onLine` is called on that thread when there is something to take, and never after the object is gone.
    explicit InputLines(std::function<void()> onLine);
    ~InputLines();
    InputLines(const InputLines &) = delete;
    InputLines &operator=(const InputLines &) = delete;

    struct Line
    {
        std::optional<std::string> Text;  // empty: the end
    };
    // Whether there is a line, or the end.
    bool Take(Line &line);

private:
    struct State;
    const std::shared_ptr<State> _state;
};

}  // namespace Rabit::Tool
