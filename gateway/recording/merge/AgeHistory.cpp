#include "recording/merge/AgeHistory.h"

#include <algorithm>
#include <cmath>

namespace Rabit::Merge
{
namespace
{

// From 10 microseconds to 100 million seconds.
constexpr double ShortestAge = 1e4;
constexpr std::size_t BinsOfADecade = 100;
constexpr std::size_t Bins = 13 * BinsOfADecade;

// Where a bin ends.
double EdgeOf(std::size_t bin)
{
    return ShortestAge * std::pow(10.0, static_cast<double>(bin) / static_cast<double>(BinsOfADecade));
}

std::size_t BinOf(Moment age)
{
    const double decades = std::log10(std::max(static_cast<double>(age), ShortestAge) / ShortestAge);
    const auto bin = static_cast<std::size_t>(std::ceil(decades * static_cast<double>(BinsOfADecade)));
    return std::min(bin, Bins - 1);
}

}  // namespace

AgeHistory::AgeHistory(Moment begin, Moment end, std::size_t columns)
    : _begin(begin), _end(std::max(end, begin + 1)), _columns(std::max<std::size_t>(columns, 1)), _bins(Bins)
{
}

void AgeHistory::Receive(Moment at, Moment postedAt)
{
    Grow(at);
    _at = _postedAt ? std::max(_at, at) : at;
    _postedAt = postedAt;
    ++_values;
    AddToColumns(_at, _at);
}

void AgeHistory::End(Moment at)
{
    Grow(at);
    _postedAt.reset();
}

void AgeHistory::Grow(Moment to)
{
    if (!_postedAt || to <= _at)
    {
        return;
    }
    const Moment oldest = std::max<Moment>(0, to - *_postedAt);
    AddToColumns(_at, to);
    AddToBins(std::max<Moment>(0, _at - *_postedAt), oldest);
    if (oldest > _oldest)
    {
        _oldest = oldest;
        _oldestAt = to;
    }
    _at = to;
}

void AgeHistory::AddToColumns(Moment from, Moment to)
{
    if (to < _begin || from > _end)
    {
        return;
    }
    from = std::max(from, _begin);
    to = std::min(to, _end);
    const double width = static_cast<double>(_end - _begin) / static_cast<double>(_columns.size());
    const auto columnOf = [&](Moment at)
    {
        const auto column = static_cast<std::size_t>(static_cast<double>(at - _begin) / width);
        return std::min(column, _columns.size() - 1);
    };
    for (std::size_t at = columnOf(from); at <= columnOf(to); ++at)
    {
        const Moment columnBegin = _begin + static_cast<Moment>(width * static_cast<double>(at));
        const Moment columnEnd = _begin + static_cast<Moment>(width * static_cast<double>(at + 1));
        const Moment youngest = std::max<Moment>(0, std::max(from, columnBegin) - *_postedAt);
        const Moment oldest = std::max<Moment>(youngest, std::min(to, columnEnd) - *_postedAt);
        Column &column = _columns[at];
        column.Youngest = column.IsKnown ? std::min(column.Youngest, youngest) : youngest;
        column.Oldest = column.IsKnown ? std::max(column.Oldest, oldest) : oldest;
        column.IsKnown = true;
    }
}

void AgeHistory::AddToBins(Moment youngest, Moment oldest)
{
    const std::size_t first = BinOf(youngest);
    const std::size_t last = BinOf(oldest);
    double from = static_cast<double>(youngest);
    for (std::size_t bin = first; bin <= last; ++bin)
    {
        const double to =
            bin == last ? static_cast<double>(oldest) : std::min(EdgeOf(bin), static_cast<double>(oldest));
        _bins[bin] += std::max(0.0, to - from);
        from = std::max(from, to);
    }
}

Moment AgeHistory::Percentile(double part) const
{
    double total = 0.0;
    for (const double time : _bins)
    {
        total += time;
    }
    if (total <= 0.0)
    {
        return 0;
    }
    double sum = 0.0;
    for (std::size_t bin = 0; bin < Bins; ++bin)
    {
        sum += _bins[bin];
        if (sum >= total * part && _bins[bin] > 0.0)
        {
            // A known value ages steadily, so within a bin all ages are as frequent.
            const double begin = bin == 0 ? 0.0 : EdgeOf(bin - 1);
            const double over = (sum - total * part) / _bins[bin];
            return std::min(_oldest, static_cast<Moment>(EdgeOf(bin) - over * (EdgeOf(bin) - begin)));
        }
    }
    return _oldest;
}

}  // namespace Rabit::Merge
