#include "ScreenLog.h"

#include <rabit/RabitLog.h>

#include <iostream>
#include <mutex>
#include <utility>

namespace Ground
{

// Shared with the sink, which may still run on another thread after it was replaced.
struct ScreenLog::State
{
    std::mutex Mutex;
    std::vector<std::string> Lines;
    std::size_t Dropped = 0;

    void Add(const std::string &line)
    {
        const std::lock_guard lock(Mutex);
        if (Lines.size() < MaxLines)
            Lines.push_back(line);
        else
            ++Dropped;
    }
};

ScreenLog::ScreenLog() : _state(std::make_shared<State>())
{
    Rabit::RabitLog::SetSink([state = _state](Rabit::RabitLogLevel, const std::string &line)
                             { state->Add(line); });
}

ScreenLog::~ScreenLog()
{
    Rabit::RabitLog::SetSink(nullptr);
    for (const std::string &line : Take())
        std::cerr << line << '\n';
}

std::vector<std::string> ScreenLog::Take() const
{
    const std::lock_guard lock(_state->Mutex);
    if (const auto dropped = std::exchange(_state->Dropped, 0); dropped > 0)
        _state->Lines.push_back("... and " + std::to_string(dropped) + " lines more");
    return std::exchange(_state->Lines, {});
}

}  // namespace Ground
