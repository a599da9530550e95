#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>
#include <vector>

// Data on standard output, a line at a time; talk on standard error.
namespace Rabit::Tool::Output
{

// Writes the line and a line feed at once. False if it could not be written: the program then ends, and Ended
// tells why.
bool Line(std::string_view line);
// Call once, at the end of the program, with its exit code. Writes what is buffered. If standard output took
// not all of the data, reports why and returns ProblemFound; a closed pipe changes nothing.
int Ended(int code);
// The same as Line, for several lines.
bool Lines(const std::vector<std::string> &lines);
// Writes one object in one line. Numbers that may be beyond 2^53 belong in it as strings: most readers of
// JSON hold numbers as doubles, which would round them.
bool Object(const nlohmann::ordered_json &object);
// Writes the object if the user wants JSON, else the line.
bool ObjectOrLine(bool json, const nlohmann::ordered_json &object, std::string_view line);
// Writes a line for people; the text may have come from the network.
void Talk(std::string_view text);
void Talk(const std::vector<std::string> &texts);

// Clears a terminal before a table is shown again; does nothing if standard output is no terminal.
void BeginScreen();

}  // namespace Rabit::Tool::Output
