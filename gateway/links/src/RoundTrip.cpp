#include "RoundTrip.h"

#include <algorithm>

namespace Rabit
{

void RoundTrip::Measured(LinkTime roundTrip)
{
    roundTrip = std::max(roundTrip, LinkTime(1));
    _latest = roundTrip;
    if (!IsKnown())
    {
        _smoothed = roundTrip;
        _variation = roundTrip / 2;
        return;
    }
    const LinkTime error = roundTrip > _smoothed ? roundTrip - _smoothed : _smoothed - roundTrip;
    _variation = (_variation * 3 + error) / 4;
    _smoothed = std::max((_smoothed * 7 + roundTrip) / 8, LinkTime(1));
}

}  // namespace Rabit
