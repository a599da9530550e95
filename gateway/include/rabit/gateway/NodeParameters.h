#pragma once

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace Rabit
{

// The section `parameters` of a node's configuration file: values that belong to the program, not to the
// gateway.
//
//     parameters:                       config.Parameters.Read("spacing_m", spacing, 5, 200);
//       spacing_m: 20                   config.Parameters.Read("leader", leader);
//       leader: uav1
//
// Read leaves the value as it is if the file does not have that name, so that the default stands in the
// program. It throws ConfigError if the value is of another kind or out of range, with file, line and what is
// expected. A name in the file that the program does not read is most likely mistyped: RunNode refuses it,
// unless the program calls AllowOthers.
//
// Copies share what was read. Only one thread may use it at a time, usually main().
class NodeParameters
{
public:
    // No parameters.
    NodeParameters() = default;

    bool Has(const std::string &name) const;
    void Read(const std::string &name, std::string &value) const;
    void Read(const std::string &name, bool &value) const;  // on, off, true or false
    void Read(const std::string &name, double &value, double least = -std::numeric_limits<double>::max(),
              double most = std::numeric_limits<double>::max()) const;
    void Read(const std::string &name, int &value, int least = std::numeric_limits<int>::min(),
              int most = std::numeric_limits<int>::max()) const;
    // `5s`, `200ms`, `2min`.
    void Read(const std::string &name, std::chrono::milliseconds &value) const;
    // A list of words, or one word alone.
    void Read(const std::string &name, std::vector<std::string> &value) const;
    // For a check of the program's own: throws ConfigError about the value of that name.
    [[noreturn]] void Fail(const std::string &name, const std::string &message) const;

    // Names that are not read are no error.
    void AllowOthers() const;
    // Throws ConfigError for the first name in the file that was not read, with the nearest that was.
    void RefuseOthers() const;

private:
    friend struct NodeParametersSection;
    std::shared_ptr<struct NodeParametersSection> _section;  // null: none
};

}  // namespace Rabit
