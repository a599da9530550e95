#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace Rabit::Bench
{

struct Scenario
{
    // Carries `AtOnce` messages.
    std::function<void()> Message;
    // The number of messages that arrived so far.
    std::function<std::uint64_t()> Count;
    int AtOnce = 1;
};

// The main function of a program with the arguments SCENARIO MESSAGES. Prints as JSON how many messages
// arrived, and the allocations of one. Under `valgrind --tool=callgrind --toggle-collect=Measured` the
// instructions of the messages are counted. `find` throws if there is no scenario of that name.
int Count(int argc, char **argv, Scenario (*find)(const std::string &name));

}  // namespace Rabit::Bench
