#include "AnnouncementRounds.h"

#include <algorithm>

namespace Rabit::Simulated
{

void AnnouncementRounds::OnAnnounced(Time now)
{
    if (!_begun)
    {
        _nextInitial = now + _initialGap;
    }
    else if (_initial > 0 && now >= _nextInitial)
    {
        --_initial;
        _initialGap *= 2;
        _nextInitial = now + _initialGap;
    }
    _gap = !_begun || now - _last >= Rest ? FirstGap : std::min(2 * _gap, LongestGap);
    _last = now;
    _begun = true;
    _owed = false;
}

AnnouncementRounds::Time AnnouncementRounds::Next() const
{
    Time next = _last + _period;
    if (_owed)
    {
        next = std::min(next, _last + _gap);
    }
    if (_initial > 0)
    {
        next = std::min(next, std::max(_nextInitial, _last + _gap));
    }
    return next;
}

}  // namespace Rabit::Simulated
