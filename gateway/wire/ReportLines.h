#pragma once

#include <rabit/base/Printable.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

// Reads reports of nodes (NodeReports) that have lines with tabs between the members. A report is any bytes.
namespace Rabit::ReportLines
{

// Takes the first line off the report, and returns it without its end.
inline std::string_view TakeLine(std::string_view &report)
{
    const std::size_t end = report.find('\n');
    const std::string_view line = report.substr(0, end);
    report.remove_prefix(end == std::string_view::npos ? report.size() : end + 1);
    return line;
}

// The members of a line, each printable ASCII of `longest` characters at most. Of a line with more than
// `most` members, the first `most` + 1.
inline std::vector<std::string> MembersOf(std::string_view line, std::size_t most, std::size_t longest)
{
    std::vector<std::string> members;
    for (std::size_t begin = 0; begin <= line.size() && members.size() <= most;)
    {
        const std::size_t end = line.find('\t', begin);
        members.push_back(Printable(std::string(line.substr(begin, end - begin)), longest));
        begin = end == std::string_view::npos ? line.size() + 1 : end + 1;
    }
    return members;
}

}  // namespace Rabit::ReportLines
