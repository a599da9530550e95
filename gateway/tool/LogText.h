#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace Rabit::Tool
{

// Lines of a node's log, as the node reports them. All text comes from the network.
struct LogText
{
    std::uint32_t First = 0;         // number of the first line; numbers wrap around
    std::vector<std::string> Lines;  // each printable, as `2026-11-23T04:04:07.250Z warning text`

    std::uint32_t Next() const { return First + static_cast<std::uint32_t>(Lines.size()); }
};

// Empty if the report makes no sense.
std::optional<LogText> LogTextOf(const std::string &report);

// A line in parts. `Time` and `Level` are empty if the line does not have that form.
struct LogLine
{
    std::string Time;
    std::string Level;
    std::string Text;
};
LogLine LogLineOf(const std::string &line);

}  // namespace Rabit::Tool
