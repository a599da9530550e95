#pragma once

#include <rabit/dynamic/DynamicType.h>

#include <string>
#include <utility>
#include <vector>

namespace Rabit::Tool
{

// Types from IDL files that a person names.
class IdlFiles
{
public:
    // Throws ConfigError if one cannot be read.
    explicit IdlFiles(const std::vector<std::string> &files);

    bool AreNone() const { return _texts.empty(); }
    // Returns the type of that name from the first file that has it, or the reason why there is none.
    ParsedType Find(const std::string &type) const;

private:
    std::vector<std::pair<std::string, std::string>> _texts;  // by the names of the files
};

}  // namespace Rabit::Tool
