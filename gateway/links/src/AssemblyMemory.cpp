#include "AssemblyMemory.h"

#include "Assembly.h"

#include <algorithm>

namespace Rabit
{

bool AssemblyMemory::Take(Assembly &who, std::size_t bytes, LinkTime now)
{
    if (_used + bytes > _limit)
    {
        RefuseStalled(bytes, who, now);
    }
    const bool beyond = _used + bytes > _limit;
    if (beyond && _favoured != &who && _favoured != nullptr && now - _favouredAt < Patience)
    {
        return false;
    }
    if (beyond)
    {
        _favoured = &who;
    }
    if (_favoured == &who)
    {
        _favouredAt = now;
    }
    _used += bytes;
    if (std::find(_users.begin(), _users.end(), &who) == _users.end())
    {
        _users.push_back(&who);
    }
    return true;
}

// Refuses stalled beginnings, the one stalled for longest first.
void AssemblyMemory::RefuseStalled(std::size_t bytes, const Assembly &except, LinkTime now)
{
    while (!_users.empty() && _used + bytes > _limit)
    {
        Assembly &first = **std::min_element(_users.begin(), _users.end(),
                                             [](const Assembly *a, const Assembly *b)
                                             { return a->GrownAt() < b->GrownAt(); });
        if (&first == &except || now - first.GrownAt() < Stalled)
        {
            return;
        }
        first.BeginRefused();
        std::erase(_users, &first);
    }
}

void AssemblyMemory::Give(Assembly &who, std::size_t bytes)
{
    _used -= bytes;
    std::erase(_users, &who);
    if (_favoured == &who)
    {
        _favoured = nullptr;
    }
}

}  // namespace Rabit
