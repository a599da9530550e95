#include "presence/Introductions.h"

#include <algorithm>

#include "presence/Spread.h"

namespace Rabit
{

bool Introductions::Ask(const std::string &node, Reason reason, std::size_t others, Duration now)
{
    if (!Grant(node, reason, now))
    {
        return false;
    }
    Begin(others, now);
    return true;
}

void Introductions::Begin(std::size_t others, Duration now)
{
    if (!_beatsAt)
    {
        _beatsAt = std::max(now + SpreadAmong(others, _random), _last ? *_last + Together : now);
    }
}

// The memory is bounded: it holds only nodes that were granted beats, for RestForOne.
bool Introductions::Grant(const std::string &node, Reason reason, Duration now)
{
    std::erase_if(_asked, [now](const auto &entry) { return now - entry.second >= RestForOne; });
    const Duration restedAt = std::max(_restedAt, now) + RestForAll;
    if (_asked.count({node, reason}) > 0 || restedAt - now > MostInARow * RestForAll)
    {
        return false;
    }
    _restedAt = restedAt;
    _asked[{node, reason}] = now;
    return true;
}

bool Introductions::TakeBeats(Duration now)
{
    if (!_beatsAt || now < *_beatsAt)
    {
        return false;
    }
    _beatsAt.reset();
    _last = now;
    return true;
}

}  // namespace Rabit
