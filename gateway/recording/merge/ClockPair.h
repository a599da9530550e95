#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "recording/merge/Moment.h"

namespace Rabit::Merge
{

// How the clocks of two nodes stand to each other over time, from what one of them told once a second
// (ClockReport), with a bound of the error.
//
// What is told is the estimate of a minimum filter that remembers 15 to 30 seconds, and half of the last
// round trip. The bound of one such estimate is half of the smallest round trip that the filter is known to
// remember, and what the clocks may have drifted meanwhile. How quickly they drift is measured over all of
// it; where that cannot tell they are taken to run within MostDrift of each other. Where estimates differ by
// more than that explains (a clock was slewed), their difference is part of the bound; and around a step (a
// clock stood still), so is the step.
//
// An estimate whose round trip is that of the one before says nothing new: nothing was heard. Between two,
// the clocks are taken to have drifted evenly; of those near by that with the least bound is used. Not
// thread-safe; constant after Finish.
class ClockPair
{
public:
    // Of each other, unless they are seen to run worse.
    static constexpr double MostDrift = 100e-6;
    // However even they seem to run.
    static constexpr double LeastDrift = 5e-6;

    // The same moment on both clocks. Those after the first are told in the order of the first clock, or
    // passed over; and so is what comes within half a second of the one before.
    void Add(Moment first, Moment second, std::optional<Moment> uncertainBy);
    // Before anything is asked; nothing is added after it.
    void Finish();

    struct Reading
    {
        Moment Time = 0;   // on the other clock
        Moment Bound = 0;  // how wrong that may be
    };
    // Empty if nothing of use was told.
    std::optional<Reading> ToSecond(Moment first) const { return At(first, &Entry::First, &Entry::Second); }
    std::optional<Reading> ToFirst(Moment second) const { return At(second, &Entry::Second, &Entry::First); }
    // How much of what was told is of use.
    std::size_t Count() const { return _entries.size(); }
    // By how much the clocks may drift apart, of the time that passes.
    double Drift() const { return _drift; }

private:
    struct Entry
    {
        Moment First = 0;
        Moment Second = 0;
        Moment HalfRoundTrip = 0;
        Moment RoundTripBound = 0;  // without drift
        Moment Lag = 0;             // so old may be what the filter remembers
        Moment Doubt = 0;           // by how much others near by differ, if drift does not explain it
        Moment Bound = 0;
        std::size_t Segment = 0;  // between steps
        std::size_t Best = 0;     // that is to be used at this moment

        Moment Offset() const { return Within(Second - First); }
    };

    void Split();
    void BoundByRoundTrips();
    void MeasureDrift();
    void DoubtByOthers();
    void DoubtAtSteps();
    void ChooseBest();
    std::optional<Reading> At(Moment time, Moment Entry::*from, Moment Entry::*to) const;
    Reading Use(const Entry &entry, Moment time, Moment Entry::*from, Moment Entry::*to) const;

    std::vector<Entry> _entries;
    std::optional<Moment> _beganAt;  // of the first clock
    std::optional<Moment> _lastTold;
    std::optional<Moment> _lastHalfRoundTrip;
    double _drift = MostDrift;
};

}  // namespace Rabit::Merge
