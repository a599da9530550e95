#pragma once

#include "LineMessage.h"

#include <rabit/RabitManager.h>

#include <memory>
#include <string>

// Reads lines from the standard input. A line that starts with "queue" goes as a clone into the printing
// manager's queue; one that starts with "quit" or "exit", or the end of the input, shuts the program down;
// any other is posted as "Line". Capital letters, and blanks at both ends of a line, make no difference. A
// prompt stands before each line if a terminal is read.
class ReadManager : public Rabit::RabitManager
{
public:
    ReadManager();
    void Startup() final;
    // Waits at most 200 ms for input, and handles all available lines.
    void ExecuteUnitOfWork() final;
    void Shutdown() final;

private:
    bool ReadWhatIsThere();  // false: end of input
    static void Prompt();
    void HandleLine(const std::string &untrimmed);
    void PutIntoQueue();

    const std::shared_ptr<LineMessage> _line = std::make_shared<LineMessage>();
    std::string _unfinished;
};
