#pragma once

#include <rabit/RabitManager.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <utility>

namespace RabitTest
{

// A manager whose three steps are given by the test.
class ScriptedManager : public Rabit::RabitManager
{
public:
    ScriptedManager(std::string name, Rabit::RabitWorkspace &workspace)
        : RabitManager(std::move(name), workspace)
    {
    }

    std::function<void()> OnStartup;
    std::function<void()> OnWork;
    std::function<void()> OnShutdown;
    std::atomic<int> Startups{0};
    std::atomic<int> Passes{0};
    std::atomic<int> Shutdowns{0};

    void Startup() final
    {
        ++Startups;
        Call(OnStartup);
    }
    void ExecuteUnitOfWork() final
    {
        ++Passes;
        Call(OnWork);
    }
    void Shutdown() final
    {
        ++Shutdowns;
        Call(OnShutdown);
    }

private:
    static void Call(const std::function<void()> &function)
    {
        if (function)
        {
            function();
        }
    }
};

// Waits for an event on another thread. Returns false only after a time so long that the event will never
// come; a slow machine changes nothing.
template <typename Condition>
bool Eventually(Condition condition)
{
    const auto giveUp = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!condition())
    {
        if (std::chrono::steady_clock::now() > giveUp)
        {
            return false;
        }
        std::this_thread::yield();
    }
    return true;
}

}  // namespace RabitTest
