#include "Table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace Rabit::Tool
{

std::vector<std::string> TableLines(const std::vector<std::vector<std::string>> &rows)
{
    std::vector<std::size_t> widths;
    for (const auto &row : rows)
    {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (std::size_t i = 0; i < row.size(); ++i)
        {
            widths[i] = std::max(widths[i], row[i].size());
        }
    }
    std::vector<std::string> lines;
    for (const auto &row : rows)
    {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
        {
            line += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
        }
        line.erase(line.find_last_not_of(' ') + 1);
        lines.push_back(std::move(line));
    }
    return lines;
}

std::string NamesText(const std::vector<std::string> &names)
{
    constexpr std::size_t most = 8;
    constexpr std::size_t first = 6;
    const std::size_t shown = names.size() > most ? first : names.size();
    std::string text;
    for (std::size_t i = 0; i < shown; ++i)
    {
        text += (i > 0 ? " " : "") + names[i];
    }
    if (shown < names.size())
    {
        text += " and " + std::to_string(names.size() - shown) + " more";
    }
    return text.empty() ? "-" : text;
}

std::string NumberText(double number, int digits, const char *unit)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.*f%s", digits, number, unit);
    return std::isfinite(number) ? text : "-";
}

}  // namespace Rabit::Tool
