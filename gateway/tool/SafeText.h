#pragma once

#include <string>
#include <string_view>

namespace Rabit::Tool
{

// A text from the network for a terminal, in one line: all but printable ASCII becomes `?`, so that no escape
// sequence gets through.
std::string SafeText(std::string_view text);
// The same for a text of several lines: line feeds and tabs stay.
std::string SafeLines(std::string_view text);

}  // namespace Rabit::Tool
