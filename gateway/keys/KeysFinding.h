#pragma once

#include <string>

namespace Rabit::Keys
{

// A remark on a node's keys, for people.
struct KeysFinding
{
    bool IsProblem = true;  // or a note
    std::string Text;
};

}  // namespace Rabit::Keys
