#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace Ground
{

// While it lives, what the library logs is kept for whoever draws the terminal, so that no line of the log is
// written into a table that is redrawn in place. What nobody took goes to the standard error in the end. One
// at a time.
class ScreenLog
{
public:
    // What is beyond is counted, and a line says so.
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
