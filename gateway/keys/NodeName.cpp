#include "keys/NodeName.h"

#include <rabit/keys/KeysError.h>

#include <algorithm>

namespace Rabit::Keys
{

bool IsFolderName(const std::string &name)
{
    const auto isGood = [](char c)
    {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '.' || c == '-';
    };
    return !name.empty() && name.size() <= LongestNodeName && name.front() != '.' &&
           std::all_of(name.begin(), name.end(), isGood);
}

void CheckNodeName(const std::string &node)
{
    if (!IsFolderName(node) || node == AuthorityFolder)
    {
        throw KeysError("`" + node +
                        "` cannot be the name of a node with keys; expected 1 to 64 of A-Z a-z 0-9 _ . -, no "
                        "dot in front, and not `authority`");
    }
}

}  // namespace Rabit::Keys
