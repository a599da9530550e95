#include "recording/merge/ClockPair.h"

#include <algorithm>

namespace Rabit::Merge
{
namespace
{

constexpr Moment LeastApart = OneSecond / 2;
// The filter remembers one to two of these periods.
constexpr Moment FilterPeriod = 15 * OneSecond;
// A beat may have come this long before its report.
constexpr Moment ToldEvery = OneSecond;
// A step is a change by more than this, beyond the uncertainty: a smaller one may be a delay in the
// estimate.
constexpr Moment LeastStep = OneSecond / 10;
// A step is seen after this time at most.
constexpr Moment StepMargin = 5 * OneSecond;
// Other estimates may contradict one within `Contradiction` of it, and take its place within `Near`.
constexpr Moment Contradiction = 32 * OneSecond;
constexpr Moment Near = 60 * OneSecond;
// Reports that are more uncertain are ignored.
constexpr Moment MostUncertain = 3600 * OneSecond;

}  // namespace

void ClockPair::Add(Moment first, Moment second, std::optional<Moment> uncertainBy)
{
    _beganAt = std::min(_beganAt.value_or(first), first);
    if (!uncertainBy || *uncertainBy > MostUncertain || uncertainBy == _lastHalfRoundTrip ||
        (_lastUsed && first < *_lastUsed + LeastApart))
    {
        return;
    }
    _lastUsed = first;
    _lastHalfRoundTrip = uncertainBy;
    // Clocks do not go back: the entries that this one contradicts were guessed while the other clock stood
    // still.
    while (!_entries.empty() && _entries.back().Second >= second)
    {
        _entries.pop_back();
    }
    Entry entry;
    entry.First = first;
    entry.Second = second;
    entry.HalfRoundTrip = *uncertainBy;
    _entries.push_back(entry);
}

void ClockPair::Finish()
{
    Split();
    BoundByRoundTrips();
    MeasureDrift();
    DoubtByOthers();
    DoubtAtSteps();
    for (Entry &entry : _entries)
    {
        entry.Bound = Within(entry.RoundTripBound + std::max(entry.Doubt, PartOf(entry.Lag, _drift)));
    }
    ChooseBest();
}

void ClockPair::Split()
{
    for (std::size_t i = 1; i < _entries.size(); ++i)
    {
        const Entry &before = _entries[i - 1];
        Entry &entry = _entries[i];
        const Moment explained = LeastStep + before.HalfRoundTrip + entry.HalfRoundTrip +
                                 PartOf(entry.First - before.First, MostDrift);
        entry.Segment = before.Segment + (Apart(entry.Offset(), before.Offset()) > explained ? 1 : 0);
    }
}

// The filter's smallest difference is from beats that include those of the last period. Half of its
// smallest round trip was subtracted, and that may be from two periods ago.
void ClockPair::BoundByRoundTrips()
{
    std::size_t inPeriod = 0;  // the first whose beat is of the last period for sure
    std::size_t recent = 0;    // the first whose beat may be
    std::size_t oldest = 0;    // the first that the filter may remember
    for (std::size_t i = 0; i < _entries.size(); ++i)
    {
        Entry &entry = _entries[i];
        const auto advance = [this](std::size_t &at, Moment to)
        {
            while (_entries[at].First < to)
            {
                ++at;
            }
        };
        advance(inPeriod, entry.First - FilterPeriod + ToldEvery);
        advance(recent, entry.First - FilterPeriod - ToldEvery);
        Moment remembers = *_beganAt - ToldEvery;
        if (recent > 0)
        {
            remembers = std::max(remembers, _entries[recent - 1].First - FilterPeriod - ToldEvery);
        }
        advance(oldest, remembers);
        Moment ofPeriod = entry.HalfRoundTrip;
        Moment ofAll = entry.HalfRoundTrip;
        for (std::size_t j = oldest; j < i; ++j)
        {
            ofAll = std::min(ofAll, _entries[j].HalfRoundTrip);
            if (j >= inPeriod && _entries[j].Segment == entry.Segment)
            {
                ofPeriod = std::min(ofPeriod, _entries[j].HalfRoundTrip);
            }
        }
        // After a step the filter has forgotten its differences, but not its round trips, and these are not
        // all reported.
        const bool isNewSegment = _entries[oldest].Segment != entry.Segment;
        entry.RoundTripBound = 2 * ofPeriod - (isNewSegment ? 0 : ofAll);
        entry.Lag = entry.First - remembers;
    }
}

// Measures between a good early and a good late estimate of the longest stretch without a step.
void ClockPair::MeasureDrift()
{
    std::size_t begin = 0;
    std::size_t end = 0;
    for (std::size_t i = 0, from = 0; i < _entries.size(); ++i)
    {
        from = _entries[i].Segment == _entries[from].Segment ? from : i;
        if (_entries[i].First - _entries[from].First > _entries[end].First - _entries[begin].First)
        {
            begin = from;
            end = i;
        }
    }
    if (begin == end)
    {
        return;
    }
    const Moment third = (_entries[end].First - _entries[begin].First) / 3;
    std::size_t early = begin;
    std::size_t late = end;
    for (std::size_t i = begin; i <= end; ++i)
    {
        const Entry &entry = _entries[i];
        if (entry.First - _entries[begin].First <= third &&
            entry.RoundTripBound < _entries[early].RoundTripBound)
        {
            early = i;
        }
        if (_entries[end].First - entry.First <= third &&
            entry.RoundTripBound < _entries[late].RoundTripBound)
        {
            late = i;
        }
    }
    const Entry &one = _entries[early];
    const Entry &other = _entries[late];
    const Moment lag = std::max(one.Lag, other.Lag);
    const Moment time = other.First - one.First;
    if (time <= 2 * lag)
    {
        return;
    }
    const auto drifted = static_cast<double>(Apart(one.Offset(), other.Offset()));
    const auto uncertain = static_cast<double>(one.RoundTripBound + other.RoundTripBound);
    const double most = (drifted + uncertain) / static_cast<double>(time - lag);
    const double least = (drifted - uncertain) / static_cast<double>(time + lag);
    _drift = std::max({LeastDrift, std::min(MostDrift, most), least});
}

void ClockPair::DoubtByOthers()
{
    std::size_t from = 0;
    for (Entry &entry : _entries)
    {
        while (_entries[from].First < entry.First - Contradiction)
        {
            ++from;
        }
        for (std::size_t j = from; j < _entries.size() && _entries[j].First <= entry.First + Contradiction;
             ++j)
        {
            const Entry &other = _entries[j];
            const Moment uncertain = entry.RoundTripBound + other.RoundTripBound;
            const Moment differ = Apart(entry.Offset(), other.Offset());
            const Moment time = Apart(entry.First, other.First) + std::max(entry.Lag, other.Lag);
            if (other.Segment == entry.Segment && differ > uncertain + PartOf(time, _drift))
            {
                entry.Doubt = std::max(entry.Doubt, Within(differ + uncertain));
            }
        }
    }
}

void ClockPair::DoubtAtSteps()
{
    for (std::size_t i = 1; i < _entries.size(); ++i)
    {
        if (_entries[i].Segment == _entries[i - 1].Segment)
        {
            continue;
        }
        const Moment before = _entries[i - 1].First;
        const Moment after = _entries[i].First;
        const Moment step = Within(Apart(_entries[i].Offset(), _entries[i - 1].Offset()) +
                                   _entries[i].RoundTripBound + _entries[i - 1].RoundTripBound);
        for (std::size_t j = i; j-- > 0 && before - _entries[j].First < StepMargin;)
        {
            _entries[j].Doubt = Within(_entries[j].Doubt + step);
        }
        for (std::size_t j = i; j < _entries.size() && _entries[j].First - after < StepMargin; ++j)
        {
            _entries[j].Doubt = Within(_entries[j].Doubt + step);
        }
    }
}

void ClockPair::ChooseBest()
{
    std::size_t from = 0;
    for (std::size_t i = 0; i < _entries.size(); ++i)
    {
        Entry &entry = _entries[i];
        while (_entries[from].First < entry.First - Near)
        {
            ++from;
        }
        Moment least = entry.Bound;
        entry.Best = i;
        for (std::size_t j = from; j < _entries.size() && _entries[j].First <= entry.First + Near; ++j)
        {
            const Moment bound = Within(_entries[j].Bound + entry.Doubt +
                                        PartOf(Apart(_entries[j].First, entry.First), _drift));
            if (_entries[j].Segment == entry.Segment && bound < least)
            {
                least = bound;
                entry.Best = j;
            }
        }
    }
}

ClockPair::Reading ClockPair::Use(const Entry &entry, Moment time, Moment Entry::*from,
                                  Moment Entry::*to) const
{
    const Entry &best = _entries[entry.Best];
    const Moment doubt = &best == &entry ? 0 : entry.Doubt;
    return {Within(time + best.*to - best.*from),
            Within(best.Bound + doubt + PartOf(Apart(time, best.*from), _drift))};
}

std::optional<ClockPair::Reading> ClockPair::At(Moment time, Moment Entry::*from, Moment Entry::*to) const
{
    if (_entries.empty())
    {
        return std::nullopt;
    }
    const auto after = std::upper_bound(_entries.begin(), _entries.end(), time,
                                        [from](Moment one, const Entry &entry) { return one < entry.*from; });
    if (after == _entries.begin())
    {
        return Use(*after, time, from, to);
    }
    const Entry &before = *std::prev(after);
    const Reading left = Use(before, time, from, to);
    if (after == _entries.end())
    {
        return left;
    }
    const Reading right = Use(*after, time, from, to);
    const Moment past = time - before.*from;
    const Moment between = (*after).*from - before.*from;
    if (before.Segment != after->Segment)
    {
        // The step was somewhere between the two.
        return Reading{(past < between / 2 ? left : right).Time,
                       Within(std::max(left.Bound, right.Bound) + Apart(left.Time, right.Time))};
    }
    const double part = static_cast<double>(past) / static_cast<double>(between);
    return Reading{left.Time + PartOf(right.Time - left.Time, part),
                   left.Bound + PartOf(right.Bound - left.Bound, part)};
}

}  // namespace Rabit::Merge
