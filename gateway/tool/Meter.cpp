#include "Meter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace Rabit::Tool
{
namespace
{

constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void Meter::Add(double at, std::size_t bytes, double age)
{
    if (_ages.empty())
    {
        _first = at;
    }
    else
    {
        _gaps.push_back(at - _last);
    }
    _last = at;
    _bytes += bytes;
    _ages.push_back(age);
}

double Meter::Rate() const
{
    return _last > _first ? static_cast<double>(_gaps.size()) / (_last - _first) : Unknown;
}

double Meter::ShortestGap() const
{
    return _gaps.empty() ? Unknown : *std::min_element(_gaps.begin(), _gaps.end());
}

double Meter::LongestGap() const
{
    return _gaps.empty() ? Unknown : *std::max_element(_gaps.begin(), _gaps.end());
}

double Meter::Jitter() const
{
    if (_gaps.empty())
    {
        return Unknown;
    }
    const auto count = static_cast<double>(_gaps.size());
    const double mean = std::accumulate(_gaps.begin(), _gaps.end(), 0.0) / count;
    const double sum =
        std::accumulate(_gaps.begin(), _gaps.end(), 0.0,
                        [mean](double before, double gap) { return before + (gap - mean) * (gap - mean); });
    return std::sqrt(sum / count);
}

double Meter::MeanBytes() const
{
    return _ages.empty() ? Unknown : static_cast<double>(_bytes) / static_cast<double>(_ages.size());
}

double Meter::Age(double part) const
{
    if (_ages.empty())
    {
        return Unknown;
    }
    std::vector<double> ages = _ages;
    std::sort(ages.begin(), ages.end());
    const auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(ages.size())));
    return ages[std::clamp<std::size_t>(rank, 1, ages.size()) - 1];
}

}  // namespace Rabit::Tool
