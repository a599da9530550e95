#pragma once

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <system_error>

namespace TestNode
{

// CLOCK_MONOTONIC in ns, which all network namespaces of one machine share.
inline std::int64_t Now()
{
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// Appends to the ledger file, each line with one write(2), so that several objects may write to one file.
// One thread.
class LedgerFile
{
public:
    explicit LedgerFile(const std::string &path)
        : _file(open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644))
    {
        if (_file < 0)
            throw std::system_error(errno, std::generic_category(), path);
        Append("\n");  // ends a line that the kill of an earlier life may have cut short
    }
    ~LedgerFile() { close(_file); }
    LedgerFile(const LedgerFile &) = delete;
    LedgerFile &operator=(const LedgerFile &) = delete;

    void Line(const std::string &text) { Append(std::to_string(Now()) + ' ' + text + '\n'); }

private:
    void Append(const std::string &line)
    {
        const ssize_t written = write(_file, line.data(), line.size());
        if (written != static_cast<ssize_t>(line.size()))
            throw std::system_error(errno, std::generic_category(), "writing the ledger");
    }

    int _file;
};

}  // namespace TestNode
