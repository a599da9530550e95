#pragma once

#include <string>
#include <vector>

namespace Rabit::Keys
{

// The topics that a node writes and reads. A tool reads `*`.
struct Access
{
    std::vector<std::string> Publish{};
    std::vector<std::string> Subscribe{};
};

}  // namespace Rabit::Keys
