#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace Rabit
{

// Keeps the last lines of this process's log, for nodes that request them (NodeReports::Kind::LastLines,
// LinesFrom). A report is the number of its first line, modulo 2^32, and the lines, each with its end.
// Thread-safe.
class OwnLog
{
public:
    static constexpr std::size_t MostLines = 1000;
    static constexpr std::size_t MostBytes = 64 * 1024;
    static constexpr std::size_t LongestLine = 1000;

    // Begins with a line of its own, so that no report is empty.
    explicit OwnLog(const std::string &firstLine);

    // The last lines, at most `count`, as many as fit into a report.
    std::string Last(std::uint32_t count) const;
    // The lines from that number on, or from the oldest one if that line is not kept, as many as fit into a
    // report; empty if the number is that of the next line.
    std::optional<std::string> From(std::uint32_t number) const;

private:
    struct Lines;

    std::shared_ptr<Lines> _lines;
    std::shared_ptr<void> _listener;
};

}  // namespace Rabit
