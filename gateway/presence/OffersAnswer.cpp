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

bool OffersAnswer::IsNew(std::uint64_t asker)
{
    if (std::find(_askers.begin(), _askers.end(), asker) != _askers.end())
    {
        return false;
    }
    _askers.push_back(asker);
    if (_askers.size() > MostAskers)
    {
        _askers.pop_front();
    }
    return true;
}

void OffersAnswer::Asked(std::size_t from, std::size_t others, Duration now,
                         std::optional<std::uint64_t> asker)
{
    if (from >= _size)
    {
        return;
    }
    if (!_lastAsked || now - *_lastAsked >= Quiet)
    {
        _gap.Reset();
    }
    _lastAsked = now;
    if (!_from && _crossedUntil && now < *_crossedUntil)
    {
        return;
    }
    const bool isNew = asker && IsNew(*asker);
    const Duration notBefore = isNew ? _notBeforeForNew : _notBefore;
    if (_from && _parts == 0)
    {
        _from = std::min(*_from, from);
        _at = std::min(_at, std::max(_spreadUntil, notBefore));
    }
    else if (_from)
    {
        // The parts after *_from are sent anyway.
        if (from < *_from)
        {
            _again = std::min(_again.value_or(from), from);
            _isAgainForNew = _isAgainForNew || isNew;
        }
    }
    else
    {
        _from = from;
        _spreadUntil = now + SpreadAmong(others, _random);
        _at = std::max(_spreadUntil, notBefore);
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
        const Duration gap = _gap.Next();
        _notBefore = now + gap * _parts;
        _notBeforeForNew = now + std::min(gap, NewAskerGap) * std::exchange(_parts, 0);
        _from = std::exchange(_again, std::nullopt);
        _at = std::exchange(_isAgainForNew, false) ? _notBeforeForNew : _notBefore;
    }
}

}  // namespace Rabit
