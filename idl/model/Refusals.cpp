#include "model/Refusals.h"

#include <algorithm>
#include <cstdio>

namespace RabitIdl
{

void Refusals::Add(const std::string &file, std::uint32_t line, const std::string &message)
{
    std::string text = file + ":" + std::to_string(line) + ": " + message;
    if (std::find(_lines.begin(), _lines.end(), text) == _lines.end())
    {
        _lines.push_back(std::move(text));
    }
}

void Refusals::Print() const
{
    for (const std::string &line : _lines)
    {
        std::fprintf(stderr, "%s\n", line.c_str());
    }
}

}  // namespace RabitIdl
