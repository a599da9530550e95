#pragma once

#include "LineMessage.h"

#include <rabit/RabitManager.h>

#include <memory>

// Prints the last line that was posted, and every line that is in its queue.
class PrintManager : public Rabit::RabitManager
{
public:
    struct Options
    {
        double Period_Sec = 10.0;  // the timer
        bool WakeOnPost = false;   // be woken by every post
        bool WakeOnQueue = true;   // be woken by every message in the queue
    };

    explicit PrintManager(const Options &options);
    void Startup() final;
    void ExecuteUnitOfWork() final;
    // Prints the lines that are left.
    void Shutdown() final;

private:
    bool PrintWhatIsThere();  // true if there was a line
    static void SayThatItWaits();

    const std::shared_ptr<LineMessage> _line = std::make_shared<LineMessage>();
};
