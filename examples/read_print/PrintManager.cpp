#include "PrintManager.h"

#include <iostream>
#include <syncstream>

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
    SayThatItWaits();
}

void PrintManager::ExecuteUnitOfWork()
{
    if (PrintWhatIsThere())
    {
        SayThatItWaits();
    }
}

bool PrintManager::PrintWhatIsThere()
{
    bool printed = false;
    // A fetch brings only the last line, even if several were posted since the previous fetch.
    if (_line->FetchMessage() && _line->WasPosted())
    {
        printed = true;
        std::osyncstream(std::cout) << "posted: " << _line->Line << std::endl;
    }
    // A queue keeps all lines.
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
    {
        printed = true;
        std::osyncstream(std::cout) << "queued: " << message->ToString() << std::endl;
    }
    return printed;
}

void PrintManager::SayThatItWaits()
{
    // ReadManager writes from its own thread: without the osyncstream its text could stand before our end of
    // line.
    std::osyncstream(std::cout) << "PrintManager is waiting for a Message" << std::endl;
}

void PrintManager::Shutdown()
{
    PrintWhatIsThere();
    std::osyncstream(std::cout) << "PrintManager: shut down" << std::endl;
}
