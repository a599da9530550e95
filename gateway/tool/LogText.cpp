#include "LogText.h"

#include <rabit/base/NumberIn.h>

#include <cstddef>
#include <string_view>

#include "SafeText.h"

namespace Rabit::Tool
{

std::optional<LogText> LogTextOf(const std::string &report)
{
    LogText log;
    const std::size_t end = report.find('\n');
    const auto first = NumberIn<decltype(log.First)>(report.substr(0, end));
    if (end == std::string::npos || !first)
    {
        return std::nullopt;
    }
    log.First = *first;
    std::size_t begin = end + 1;
    for (std::size_t next = report.find('\n', begin); next != std::string::npos;
         next = report.find('\n', begin))
    {
        log.Lines.push_back(SafeText(std::string_view(report).substr(begin, next - begin)));
        begin = next + 1;
    }
    return log;
}

LogLine LogLineOf(const std::string &line)
{
    const std::size_t time = line.find(' ');
    const std::size_t level = time == std::string::npos ? time : line.find(' ', time + 1);
    if (level == std::string::npos)
    {
        return {.Time = "", .Level = "", .Text = line};
    }
    return {line.substr(0, time), line.substr(time + 1, level - time - 1), line.substr(level + 1)};
}

}  // namespace Rabit::Tool
