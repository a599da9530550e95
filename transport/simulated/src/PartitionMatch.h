#pragma once

#include <string>
#include <vector>

namespace Rabit::Simulated
{

// True if the name fits by POSIX fnmatch, as the OMG DDS specification, 2.2.3.13, requires.
bool PatternFits(const std::string &pattern, const std::string &name);

// True if two PARTITION lists have a name in common, or a name of one fits a pattern of the other. An empty
// list is the default partition, "".
bool PartitionsMatch(const std::vector<std::string> &one, const std::vector<std::string> &other);

}  // namespace Rabit::Simulated
