#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace Rabit
{

// A configuration that cannot be used. what() is one line that says where (file:line if it came from a file),
// what is wrong and what was expected. A program prints it and ends with exit code 2 before it starts
// anything.
class ConfigError : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
    // A line number of 0 and an empty file name are left out.
    ConfigError(const std::string &file, int line, const std::string &message)
        : std::runtime_error((file.empty() ? "" : file + ":") +
                             (line > 0 && !file.empty() ? std::to_string(line) + ":" : "") +
                             (file.empty() ? "" : " ") + message)
    {
    }
};

// A transport could not join the network with this configuration.
class JoinError : public ConfigError
{
public:
    JoinError(const std::string &file, int line, const std::string &message, std::string setting)
        : ConfigError(file, line, message), _setting(std::move(setting))
    {
    }
    // The setting at fault, as TransportError tells it; empty if no single one is.
    const std::string &Setting() const { return _setting; }

private:
    std::string _setting;
};

}  // namespace Rabit
