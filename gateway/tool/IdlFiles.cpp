#include "IdlFiles.h"

#include <rabit/base/ListedNames.h>
#include <rabit/dynamic/IdlFile.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/idl/NearestWord.h>

namespace Rabit::Tool
{

IdlFiles::IdlFiles(const std::vector<std::string> &files, const std::vector<std::string> &folders)
    : _files(files)
{
    for (const std::string &file : files)
    {
        const IdlFile loaded = IdlFile::Load(file, folders);
        if (!loaded.Reason.empty())
        {
            throw ConfigError(loaded.Reason);
        }
        _messages.insert(_messages.end(), loaded.Messages.begin(), loaded.Messages.end());
    }
}

ParsedType IdlFiles::Find(const std::string &type) const
{
    std::vector<std::string> names;
    for (const auto &message : _messages)
    {
        if (message->Name() == type)
        {
            return {message, ""};
        }
        names.push_back(message->Name());
    }
    return {nullptr, ListedNames(_files) + (_files.size() == 1 ? " defines" : " define") + " no message `" +
                         type + "`" + NearestWordHint(type, names)};
}

}  // namespace Rabit::Tool
