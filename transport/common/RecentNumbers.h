// Numbers for keys that peers can make up, such as addresses.
#pragma once

#include <rabit/base/Assert.h>

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <utility>

namespace Rabit
{

// Gives each key a number. Remembers the `Most` keys that were used last. A forgotten key gets another number
// when it is back: numbers rise, and none is given twice. Not thread-safe.
template <typename Key>
class RecentNumbers
{
public:
    static constexpr std::size_t Most = 4096;

    // The number of the key, and whether it has just been given.
    std::pair<std::uint64_t, bool> Of(const Key &key)
    {
        if (const auto found = _byKey.find(key); found != _byKey.end())
        {
            _used.splice(_used.begin(), _used, found->second);
            return {found->second->second, false};
        }
        if (_used.size() >= Most)
        {
            _byKey.erase(_used.back().first);
            _used.pop_back();
        }
        _used.emplace_front(key, _next);
        _byKey.emplace(key, _used.begin());
        RABIT_ASSERT(_byKey.size() == _used.size());
        return {_next++, true};
    }

    std::size_t Size() const { return _used.size(); }

private:
    using List = std::list<std::pair<Key, std::uint64_t>>;

    List _used;  // the one used last comes first
    std::map<Key, typename List::iterator> _byKey;
    std::uint64_t _next = 0;
};

}  // namespace Rabit
