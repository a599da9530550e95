#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace Ground
{

// The parts behind the head, with `, ` between them, in as many lines as it takes to stay within the columns.
// No part is cut; further lines are indented. None if there are no parts.
std::vector<std::string> WrappedLines(const std::string &head, const std::vector<std::string> &parts,
                                      std::size_t columns);

}  // namespace Ground
