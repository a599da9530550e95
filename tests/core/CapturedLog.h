#pragma once

#include <rabit/RabitLog.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace RabitTest
{

// Collects the library's log lines while it lives, instead of stderr.
class CapturedLog
{
public:
    CapturedLog()
    {
        Rabit::RabitLog::SetSink(
            [state = _state](Rabit::RabitLogLevel, const std::string &text)
            {
                const std::lock_guard<std::mutex> lock(state->Mutex);
                state->Lines.push_back(text);
            });
    }
    ~CapturedLog() { Rabit::RabitLog::SetSink(nullptr); }
    CapturedLog(const CapturedLog &) = delete;
    CapturedLog &operator=(const CapturedLog &) = delete;

    std::vector<std::string> Lines() const
    {
        const std::lock_guard<std::mutex> lock(_state->Mutex);
        return _state->Lines;
    }

private:
    struct State
    {
        std::mutex Mutex;
        std::vector<std::string> Lines;
    };
    const std::shared_ptr<State> _state = std::make_shared<State>();
};

}  // namespace RabitTest
