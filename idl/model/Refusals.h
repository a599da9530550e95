// The reasons why an IDL file is refused, each with its place.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace RabitIdl
{

class Refusals
{
public:
    void Add(const std::string &file, std::uint32_t line, const std::string &message);
    bool Empty() const { return _lines.empty(); }
    // The first reason, as Print writes it. There must be one.
    const std::string &First() const { return _lines.front(); }
    // Writes each reason once as `file:line: message` to the standard error output, in the order of Add.
    void Print() const;

private:
    std::vector<std::string> _lines;
};

}  // namespace RabitIdl
