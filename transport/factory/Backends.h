#pragma once

#include <rabit/transport/Transport.h>

#include <map>
#include <memory>
#include <string>

namespace Rabit
{

struct Backend
{
    const char *Option;                     // of CMake; it leaves the backend out of a build
    std::unique_ptr<Transport> (*Maker)();  // nullptr if this build is without the backend
};

// All backends by their words. CMake writes the table from the list in transport/CMakeLists.txt.
const std::map<std::string, Backend> &Backends();

}  // namespace Rabit
