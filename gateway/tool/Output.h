#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

// Data on standard output, a line at a time; talk on standard error.
namespace Rabit::Tool::Output
{

// Writes the line and a line feed, at once. False if nobody reads any more: then the program ends, and that
// is no fault.
bool Line(std::string_view line);
// One object in one line, in ASCII.
bool Object(const nlohmann::ordered_json &object);
// For people; the text may have come from the network.
void Talk(std::string_view text);

// Clears a terminal before a table that is shown again; nothing if standard output is none.
void BeginScreen();

}  // namespace Rabit::Tool::Output
