#pragma once

#include "LineMessage.h"

#include <rabit/RabitManager.h>

#include <memory>
#include <string>

// Reads lines from the standard input. A line that contains "queue" goes as a clone into the printing
// manager's queue; "quit", "exit" or the end of the input shut the program down; any other line is posted as
// "Line".
class ReadManager : public Rabit::RabitManager
{
public:
    ReadManager();
    // Waits a moment for input and handles all lines that are there.
    void ExecuteUnitOfWork() final;
    void Shutdown() final;

private:
    bool ReadWhatIsThere();  // false: end of input
    void HandleLine(const std::string &line);

    const std::shared_ptr<LineMessage> _line = std::make_shared<LineMessage>();
    std::string _unfinished;
};
