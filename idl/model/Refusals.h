// The reasons for which an IDL file is refused, each with its place.
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
    // The first one, as Print has it; there must be one.
    const std::string &First() const { return _lines.front(); }
    // Writes each as `file:line: message` to the standard error output, in the order of Add, each once.
    void Print() const;

private:
    std::vector<std::string> _lines;
};

}  // namespace RabitIdl
