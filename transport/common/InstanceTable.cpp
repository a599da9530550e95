#include "common/InstanceTable.h"

#include <algorithm>

namespace Rabit
{

void InstanceTable::Alive(const KeyHash &key, const WriterId &writer)
{
    auto &writers = _writersOf[key];
    if (std::find(writers.begin(), writers.end(), writer) == writers.end())
    {
        writers.push_back(writer);
    }
}

bool InstanceTable::Unregistered(const KeyHash &key, const WriterId &writer)
{
    const auto entry = _writersOf.find(key);
    if (entry == _writersOf.end() || std::erase(entry->second, writer) == 0 || !entry->second.empty())
    {
        return false;
    }
    _writersOf.erase(entry);
    return true;
}

std::vector<KeyHash> InstanceTable::WriterGone(const WriterId &writer)
{
    std::vector<KeyHash> orphans;
    for (auto entry = _writersOf.begin(); entry != _writersOf.end();)
    {
        if (std::erase(entry->second, writer) > 0 && entry->second.empty())
        {
            orphans.push_back(entry->first);
            entry = _writersOf.erase(entry);
        }
        else
        {
            ++entry;
        }
    }
    // The order of a hash table is arbitrary: sort, so that runs are repeatable.
    std::sort(orphans.begin(), orphans.end());
    return orphans;
}

}  // namespace Rabit
