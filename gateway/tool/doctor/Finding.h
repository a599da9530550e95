#pragma once

#include <string>

namespace Rabit::Tool::Doctor
{

enum class Level
{
    Good,    // was looked at, and nothing is wrong
    Note,    // worth knowing
    Problem  // keeps data from flowing, or will
};

struct Finding
{
    Level How = Level::Good;
    std::string Subject;   // `multicast on wlan0`
    std::string Text;      // what was seen
    std::string Advice{};  // what to do; empty if it is good
};

}  // namespace Rabit::Tool::Doctor
