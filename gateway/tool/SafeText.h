#pragma once

#include <string>
#include <string_view>

namespace Rabit::Tool
{

// Makes a text from the network safe for one line of a terminal: all characters except printable ASCII become
// `?`, so that no escape sequence gets through.
std::string SafeText(std::string_view text);
// The same for a text of several lines: line feeds and tabs stay.
std::string SafeLines(std::string_view text);

}  // namespace Rabit::Tool
