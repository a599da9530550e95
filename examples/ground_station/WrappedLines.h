#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace Ground
{

// The parts behind the head, with `, ` between them, wrapped into lines that fit the columns. No part is
// cut; further lines are indented. Empty if there are no parts.
std::vector<std::string> WrappedLines(const std::string &head, const std::vector<std::string> &parts,
                                      std::size_t columns);

}  // namespace Ground
