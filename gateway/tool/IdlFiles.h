#pragma once

#include <rabit/dynamic/DynamicType.h>

#include <memory>
#include <string>
#include <vector>

namespace Rabit::Tool
{

// Types from IDL files, or .msg files of ROS 2, that a person names.
class IdlFiles
{
public:
    // Throws ConfigError if one cannot be loaded. Files that they include are also looked for in `folders`.
    explicit IdlFiles(const std::vector<std::string> &files, const std::vector<std::string> &folders = {});

    bool AreNone() const { return _files.empty(); }
    // Returns the type of that name from the first file that has it, or the reason why there is none. The
    // type has the definition of programs that were built with the file.
    ParsedType Find(const std::string &type) const;

private:
    std::vector<std::string> _files;
    std::vector<std::shared_ptr<const DynamicType>> _messages;
};

}  // namespace Rabit::Tool
