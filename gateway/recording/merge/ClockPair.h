#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "recording/merge/Moment.h"

namespace Rabit::Merge
{

// The relation between the clocks of two nodes over time, with a bound of its error. It comes from the
// reports that one of them made once a second (ClockReport).
//
// A report holds the estimate of a minimum filter that remembers 15 to 30 seconds, and half of the last
// round trip. The bound of an estimate is half of the smallest round trip that the filter is known to
// remember. The possible drift of the clocks meanwhile is added. The drift is measured over all reports; if
// they are too few, it is taken as MostDrift. If estimates differ by more than drift explains (a clock was
// slewed), their difference is part of the bound. Around a step (a clock stood still), the step is part of
// the bound, too.
//
// An estimate with the round trip of the one before is ignored, since nothing was heard meanwhile. Between
// two estimates the clocks are taken to have drifted evenly. Of the estimates near by, the one with the
// least bound is used. Not thread-safe; constant after Finish.
class ClockPair
{
public:
    // Most drift between two clocks, unless more is measured.
    static constexpr double MostDrift = 100e-6;
    // Least drift that is assumed, however even the clocks seem to run.
    static constexpr double LeastDrift = 5e-6;

    // Adds the same moment on both clocks. To be called in the order of the first clock: moments that are
    // not at least half a second after the last one that is of use are ignored.
    void Add(Moment first, Moment second, std::optional<Moment> uncertainBy);
    // To be called once, after the last Add and before the first query.
    void Finish();

    struct Reading
    {
        Moment Time = 0;   // on the other clock
        Moment Bound = 0;  // how wrong that may be
    };
    // Convert a reading of one clock to the other; empty if no report is of use.
    std::optional<Reading> ToSecond(Moment first) const { return At(first, &Entry::First, &Entry::Second); }
    std::optional<Reading> ToFirst(Moment second) const { return At(second, &Entry::Second, &Entry::First); }
    // Number of reports that are of use.
    std::size_t Count() const { return _entries.size(); }
    // The part of the passing time by which the clocks may drift apart.
    double Drift() const { return _drift; }

private:
    struct Entry
    {
        Moment First = 0;
        Moment Second = 0;
        Moment HalfRoundTrip = 0;
        Moment RoundTripBound = 0;  // without drift
        Moment Lag = 0;             // so old may be the memory of the filter
        Moment Doubt = 0;           // difference to others near by, if drift does not explain it
        Moment Bound = 0;
        std::size_t Segment = 0;  // between steps
        std::size_t Best = 0;     // the entry to be used at this moment

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
    std::optional<Moment> _lastUsed;
    std::optional<Moment> _lastHalfRoundTrip;
    double _drift = MostDrift;
};

}  // namespace Rabit::Merge
