#include "ReadManager.h"

#include <array>
#include <cstddef>
#include <iostream>

#include <poll.h>
#include <unistd.h>

namespace
{

// The unit of work blocks no longer than this, so that the manager notices when it is told to shut down.
constexpr int LongestWait_MSec = 200;

}  // namespace

ReadManager::ReadManager() : RabitManager("ReadManager")
{
    AddPublishSubscribeMessage("Line", _line);
    // The unit of work itself waits for input: no sleep in between.
    SetWakeupTimeDelayMSec(0);
}

void ReadManager::ExecuteUnitOfWork()
{
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, LongestWait_MSec) <= 0)
    {
        return;
    }
    const bool more = ReadWhatIsThere();
    for (std::size_t end = _unfinished.find('\n'); end != std::string::npos; end = _unfinished.find('\n'))
    {
        const std::string line = _unfinished.substr(0, end);
        _unfinished.erase(0, end + 1);
        HandleLine(line);
    }
    if (!more)
    {
        ShutdownAllManagers(true);
    }
}

bool ReadManager::ReadWhatIsThere()
{
    std::array<char, 4096> buffer;
    const ssize_t count = read(STDIN_FILENO, buffer.data(), buffer.size());
    if (count <= 0)
    {
        return false;
    }
    _unfinished.append(buffer.data(), static_cast<std::size_t>(count));
    return true;
}

void ReadManager::HandleLine(const std::string &line)
{
    if (line == "quit" || line == "exit")
    {
        ShutdownAllManagers(true);
        return;
    }
    _line->Line = line;
    if (line.find("queue") == std::string::npos)
    {
        _line->PostMessage();
        return;
    }
    // A clone, because the queue keeps the message while the next line overwrites ours.
    if (!AddMessageToQueue("PrintManager", std::shared_ptr<Rabit::RabitMessage>(_line->Clone())))
    {
        std::cerr << "ReadManager: the queue of PrintManager is full, lost: " << line << std::endl;
    }
}

void ReadManager::Shutdown()
{
    std::cout << "ReadManager: shut down" << std::endl;
}
