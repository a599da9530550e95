// How tests wait for what another thread, process or node does in its own time, however long that takes.
#pragma once

#include <chrono>
#include <thread>

namespace RabitTest
{

// The end of a test that hangs: longer than anything takes, also with sanitizers on a slow machine.
constexpr std::chrono::seconds Hangs{100};

// For functions that take the time at which they give up.
inline std::chrono::steady_clock::time_point WhenItHangs()
{
    return std::chrono::steady_clock::now() + Hangs;
}

// Waits until the condition holds. Returns false if it never does. To be used where nothing tells the change;
// else a condition variable is better.
template <typename Condition>
bool Eventually(Condition condition)
{
    for (const auto end = WhenItHangs(); !condition();)
    {
        if (std::chrono::steady_clock::now() > end)
        {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

}  // namespace RabitTest
