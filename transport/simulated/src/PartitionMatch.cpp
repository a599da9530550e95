#include "PartitionMatch.h"

#include <fnmatch.h>

namespace Rabit::Simulated
{

bool PatternFits(const std::string &pattern, const std::string &name)
{
    return pattern == name || fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

bool PartitionsMatch(const std::vector<std::string> &one, const std::vector<std::string> &other)
{
    static const std::vector<std::string> defaultPartition{""};
    for (const auto &a : one.empty() ? defaultPartition : one)
    {
        for (const auto &b : other.empty() ? defaultPartition : other)
        {
            if (PatternFits(a, b) || PatternFits(b, a))
            {
                return true;
            }
        }
    }
    return false;
}

}  // namespace Rabit::Simulated
