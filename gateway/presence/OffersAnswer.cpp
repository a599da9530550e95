#include "presence/OffersAnswer.h"

#include <algorithm>
#include <utility>

#include "presence/Spread.h"

namespace Rabit
{

void OffersAnswer::Begin(std::size_t size)
{
    _size = size;
    _from = 0;
    _at = Duration(0);
}

void OffersAnswer::Asked(std::size_t from, std::size_t others, Duration now)
{
    if (from >= _size)
    {
        return;
    }
    if (!_lastAsked || now - *_lastAsked >= Quiet)
    {
        _gap = ShortestGap;
        _answers = 0;
    }
    _lastAsked = now;
    if (_from && _parts == 0)
    {
        _from = std::min(*_from, from);
    }
    else if (_from)
    {
        // The parts after *_from are sent anyway.
        if (from < *_from)
        {
            _again = std::min(_again.value_or(from), from);
        }
    }
    else if (!_crossedUntil || now >= *_crossedUntil)
    {
        _from = from;
        _at = std::max(now + SpreadAmong(others, _random), _notBefore);
    }
}

void OffersAnswer::Said(std::size_t bytes, Duration now, Duration delay)
{
    if (!_from)
    {
        return;
    }
    ++_parts;
    *_from += bytes;
    _at = now + PartGap;
    if (*_from >= _size)
    {
        _crossedUntil = now + std::max(ShortestGap, 2 * delay);
        _notBefore = now + _gap * std::exchange(_parts, 0);
        _gap = std::min(2 * _gap, ++_answers < QuickAnswers ? QuickGap : LongestGap);
        _from = std::exchange(_again, std::nullopt);
        _at = _notBefore;
    }
}

}  // namespace Rabit
