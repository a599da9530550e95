#include "IdlFiles.h"

#include <rabit/base/WithoutByteOrderMark.h>
#include <rabit/gateway/ConfigError.h>

#include <fstream>
#include <sstream>

namespace Rabit::Tool
{

IdlFiles::IdlFiles(const std::vector<std::string> &files)
{
    for (const std::string &file : files)
    {
        std::ostringstream text;
        if (std::ifstream stream(file, std::ios::binary); !stream || !(text << stream.rdbuf()))
        {
            throw ConfigError(file, 0, "cannot be read");
        }
        _texts.emplace_back(file, WithoutByteOrderMark(text.str()));
    }
}

ParsedType IdlFiles::Find(const std::string &type) const
{
    ParsedType found;
    for (const auto &[file, text] : _texts)
    {
        ParsedType parsed = DynamicType::Parse(text, type);
        if (parsed.Type)
        {
            return parsed;
        }
        found.Reason += (found.Reason.empty() ? "" : "; ") + file + ": " + parsed.Reason;
    }
    return found;
}

}  // namespace Rabit::Tool
