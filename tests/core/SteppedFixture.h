#pragma once

#include "TestManagers.h"

#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/RabitWorkspace.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>

namespace RabitTest
{

// A stepped reactor under a clock that starts at 0.
struct SteppedFixture
{
    std::shared_ptr<Rabit::ManualClock> Clock = std::make_shared<Rabit::ManualClock>(1000.0);
    Rabit::RabitWorkspace Workspace{Clock};
    Rabit::RabitSteppedReactor Reactor{Workspace};

    ScriptedManager &Add(const std::string &name)
    {
        auto manager = std::make_unique<ScriptedManager>(name, Workspace);
        ScriptedManager &added = *manager;
        Reactor.AddManager(std::move(manager));
        return added;
    }

    int RunFor(std::chrono::nanoseconds duration) { return Reactor.RunFor(*Clock, duration); }

    // Returns the status message of a manager as others see it.
    std::unique_ptr<Rabit::ManagerStatusMessage> StatusOf(const std::string &name)
    {
        auto message = Workspace.GetMessage(name + ":ManagerStatusMessage");
        return std::unique_ptr<Rabit::ManagerStatusMessage>(
            dynamic_cast<Rabit::ManagerStatusMessage *>(message.release()));
    }
};

}  // namespace RabitTest
