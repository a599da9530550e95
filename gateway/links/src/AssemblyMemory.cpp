#include "AssemblyMemory.h"

namespace Rabit
{

bool AssemblyMemory::Take(const void *who, std::size_t bytes, LinkTime now)
{
    const bool beyond = _used + bytes > _limit;
    if (beyond && _favoured != who && _favoured != nullptr && now - _favouredAt < Patience)
    {
        return false;
    }
    if (beyond)
    {
        _favoured = who;
    }
    if (_favoured == who)
    {
        _favouredAt = now;
    }
    _used += bytes;
    return true;
}

void AssemblyMemory::Give(const void *who, std::size_t bytes)
{
    _used -= bytes;
    if (_favoured == who)
    {
        _favoured = nullptr;
    }
}

}  // namespace Rabit
