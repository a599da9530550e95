#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace Ground
{

// While it lives, keeps the library's log lines for the code that draws the terminal. So no line is written
// into a table that is redrawn in place. Its destructor writes lines that were not taken to the standard
// error. There may be only one at a time.
class ScreenLog
{
public:
    // Lines beyond this number are counted, and a line tells their number.
    static constexpr std::size_t MaxLines = 100;

    ScreenLog();
    ~ScreenLog();
    ScreenLog(const ScreenLog &) = delete;
    ScreenLog &operator=(const ScreenLog &) = delete;

    // The lines since the last call. Any thread.
    std::vector<std::string> Take() const;

private:
    struct State;
    const std::shared_ptr<State> _state;
};

}  // namespace Ground
