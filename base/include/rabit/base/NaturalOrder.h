#pragma once

#include <cstring>
#include <string>

namespace Rabit
{

// Orders names as people expect: `uav2` before `uav10`. The names hold no NUL.
struct NaturalOrder
{
    bool operator()(const std::string &one, const std::string &other) const
    {
        return ::strverscmp(one.c_str(), other.c_str()) < 0;
    }
};

}  // namespace Rabit
