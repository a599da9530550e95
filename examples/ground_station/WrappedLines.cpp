#include "WrappedLines.h"

namespace Ground
{

std::vector<std::string> WrappedLines(const std::string &head, const std::vector<std::string> &parts,
                                      std::size_t columns)
{
    std::vector<std::string> lines;
    std::string line = head;
    bool empty = true;
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
        const std::string text = parts[i] + (i + 1 < parts.size() ? "," : "");
        if (!empty && line.size() + 1 + text.size() > columns)
        {
            lines.push_back(line);
            line = "   ";
        }
        line += " " + text;
        empty = false;
    }
    if (!empty)
        lines.push_back(line);
    return lines;
}

}  // namespace Ground
