#include "RoundTrips.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace Rabit::Tool
{

void RoundTrips::Answered(double seconds)
{
    _sorted.insert(std::upper_bound(_sorted.begin(), _sorted.end(), seconds), seconds);
}

double RoundTrips::Loss() const
{
    return Sent() == 0 ? std::numeric_limits<double>::quiet_NaN()
                       : static_cast<double>(_lost) / static_cast<double>(Sent());
}

double RoundTrips::Percentile(double share) const
{
    if (_sorted.empty())
    {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const double place = std::ceil(share * static_cast<double>(_sorted.size())) - 1.0;
    return _sorted[static_cast<std::size_t>(std::max(place, 0.0))];
}

}  // namespace Rabit::Tool
