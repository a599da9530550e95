#pragma once

#include <rabit/base/Assert.h>

#include <cstddef>
#include <functional>
#include <iterator>
#include <list>
#include <map>
#include <utility>

namespace Rabit
{

// The entries that were put last, for keys that peers can make up. Not thread-safe.
template <typename Key, typename Value, typename Less = std::less<Key>>
class RecentMap
{
public:
    explicit RecentMap(std::size_t most) : _most(most) {}

    // The entry is now the newest one. Forgets the oldest one if there are too many.
    void Put(const Key &key, Value value)
    {
        if (const auto found = _byKey.find(key); found != _byKey.end())
        {
            found->second->second = std::move(value);
            _entries.splice(_entries.end(), _entries, found->second);
            return;
        }
        if (_entries.size() >= _most)
        {
            Erase(Key(_entries.front().first));
        }
        _entries.emplace_back(key, std::move(value));
        _byKey.emplace(key, std::prev(_entries.end()));
        RABIT_ASSERT(_byKey.size() == _entries.size());
    }
    // Null: there is none.
    const Value *Find(const Key &key) const
    {
        const auto found = _byKey.find(key);
        return found == _byKey.end() ? nullptr : &found->second->second;
    }
    void Erase(const Key &key)
    {
        if (const auto found = _byKey.find(key); found != _byKey.end())
        {
            _entries.erase(found->second);
            _byKey.erase(found);
        }
    }
    std::size_t Size() const { return _entries.size(); }

private:
    using List = std::list<std::pair<Key, Value>>;

    const std::size_t _most;
    List _entries;  // the oldest first
    std::map<Key, typename List::iterator, Less> _byKey;
};

}  // namespace Rabit
