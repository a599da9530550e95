// Managers, messages and queues of one process. Pages of the manual show the parts between markers.
#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitMessage.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitReactor.h>
#include <rabit/RabitSteppedReactor.h>

#include <chrono>
#include <memory>

#include "uav.idl.h"

namespace
{

using namespace std::chrono_literals;

// [manager]
class Autopilot : public Rabit::RabitManager
{
public:
    explicit Autopilot(Rabit::RabitWorkspace &workspace) : RabitManager("Autopilot", workspace)
    {
        AddPublishSubscribeMessage("Pose", _pose);
        SetPeriodSec(0.1);  // ten times a second
    }

    void ExecuteUnitOfWork() final
    {
        _pose->altitude_m += 0.5;
        ++_pose->number;
        _pose->PostMessage();
    }

private:
    const std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
};
// [/manager]

// [queue]
class Mission : public Rabit::RabitManager
{
public:
    explicit Mission(Rabit::RabitWorkspace &workspace) : RabitManager("Mission", workspace)
    {
        AddPublishSubscribeMessage("Pose", _pose);
    }

    void ExecuteUnitOfWork() final  // at once for each message in its queue
    {
        _pose->FetchMessage();
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            if (const auto goTo = std::dynamic_pointer_cast<Uav::Goto>(message))
            {
                AltitudeToGo = goTo->altitude_m - _pose->altitude_m;
            }
        }
    }

    double AltitudeToGo = 0.0;

private:
    const std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
};
// [/queue]

TEST(FirstManager, AManagerTakesCommandsFromItsQueue)
{
    const auto clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace workspace(clock);
    Rabit::RabitSteppedReactor reactor(workspace);
    auto mission = std::make_unique<Mission>(workspace);
    const Mission &shown = *mission;
    reactor.AddManager(std::make_unique<Autopilot>(workspace));
    reactor.AddManager(std::move(mission));
    reactor.Start();
    reactor.RunFor(*clock, 950ms);

    const auto command = std::make_shared<Uav::Goto>();
    command->altitude_m = 100;
    EXPECT_TRUE(workspace.AddMessageToQueue("Mission", command));
    reactor.RunDue();

    EXPECT_DOUBLE_EQ(shown.AltitudeToGo, 95);
}

// [main]
class Once : public Rabit::RabitManager
{
public:
    explicit Once(Rabit::RabitWorkspace &workspace) : RabitManager("Once", workspace) {}
    void ExecuteUnitOfWork() final
    {
        WriteLog(Rabit::RabitLogLevel::Info, "everything was done");
        ShutdownAllManagers(true);  // as Ctrl-C does
    }
};

void RunProgram(Rabit::RabitWorkspace &workspace)
{
    Rabit::RabitReactor reactor(workspace);
    reactor.AddManager(std::make_unique<Once>(workspace));
    reactor.Run();  // until all managers have shut down
}
// [/main]

TEST(FirstManager, AReactorRunsManagersOnTheirThreads)
{
    Rabit::RabitWorkspace workspace;
    RunProgram(workspace);
    EXPECT_EQ(workspace.GetListOfMessages().size(), 0u);
}

}  // namespace
