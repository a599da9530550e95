#include "ReadManager.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <iostream>
#include <string_view>
#include <syncstream>

#include <poll.h>
#include <unistd.h>

namespace
{

// The unit of work blocks no longer than this, so that the manager notices a shutdown request.
constexpr int LongestWait_MSec = 200;

std::string Trimmed(const std::string &text)
{
    constexpr const char *blanks = " \t\r\v\f";
    const std::size_t first = text.find_first_not_of(blanks);
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// Ignores case.
bool StartsWith(const std::string &text, std::string_view lowerCaseWord)
{
    return text.size() >= lowerCaseWord.size() &&
           std::equal(lowerCaseWord.begin(), lowerCaseWord.end(), text.begin(),
                      [](char wanted, char letter)
                      { return std::tolower(static_cast<unsigned char>(letter)) == wanted; });
}

}  // namespace

ReadManager::ReadManager() : RabitManager("ReadManager")
{
    AddPublishSubscribeMessage("Line", _line);
    // The unit of work itself waits for input: no sleep in between.
    SetWakeupTimeDelayMSec(0);
}

void ReadManager::Startup()
{
    Prompt();
}

void ReadManager::Prompt()
{
    if (isatty(STDIN_FILENO) == 1)
    {
        std::osyncstream(std::cout) << "Type a line (quit or exit ends): " << std::flush;
    }
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

void ReadManager::HandleLine(const std::string &untrimmed)
{
    const std::string line = Trimmed(untrimmed);
    if (StartsWith(line, "quit") || StartsWith(line, "exit"))
    {
        ShutdownAllManagers(true);
        return;
    }
    _line->Line = line;
    if (StartsWith(line, "queue"))
    {
        PutIntoQueue();
    }
    else
    {
        _line->PostMessage();
    }
    Prompt();
}

void ReadManager::PutIntoQueue()
{
    // A clone, because the queue keeps the message while the next line overwrites ours.
    if (!AddMessageToQueue("PrintManager", std::shared_ptr<Rabit::RabitMessage>(_line->Clone())))
    {
        std::osyncstream(std::cerr) << "ReadManager: the queue of PrintManager is full, lost: " << _line->Line
                                    << std::endl;
    }
}

void ReadManager::Shutdown()
{
    std::osyncstream(std::cout) << "ReadManager: shut down" << std::endl;
}
