#include "PrintManager.h"

#include <iostream>

PrintManager::PrintManager(const Options &options) : RabitManager("PrintManager")
{
    SetWakeupTimeDelaySec(options.Period_Sec);
    AddPublishSubscribeMessage("Line", _line);
    if (options.WakeOnPost)
    {
        WakeUpManagerOnMessagePost(_line);
    }
    SetWakeupManagerUponMessagePostedToManagersMessageQueue(options.WakeOnQueue);
}

void PrintManager::Startup()
{
    std::cout << "PrintManager: ready" << std::endl;
}

void PrintManager::ExecuteUnitOfWork()
{
    // A fetch brings the last line only, however many were posted since the one before.
    if (_line->FetchMessage())
    {
        std::cout << "posted: " << _line->Line << std::endl;
    }
    // A queue keeps them all.
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
    {
        std::cout << "queued: " << message->ToString() << std::endl;
    }
}

void PrintManager::Shutdown()
{
    ExecuteUnitOfWork();
    std::cout << "PrintManager: shut down" << std::endl;
}
