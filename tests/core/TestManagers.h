#pragma once

#include <rabit/RabitManager.h>

#include <atomic>
#include <functional>
#include <string>
#include <utility>

#include "../Eventually.h"

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

}  // namespace RabitTest
