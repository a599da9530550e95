#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "recording/merge/Moment.h"

namespace Rabit::Merge
{

// How old what a node knew of a message was, over time: it grows with time, and falls when something newer
// comes. In bounded memory, however long it goes on: for a plot the range of ages in each column of it, and
// how much time was spent at which age. Not thread-safe.
class AgeHistory
{
public:
    // For a plot of that time, in so many columns, one at least. What is outside is cut off.
    AgeHistory(Moment begin, Moment end, std::size_t columns);

    // A value came that was posted at that moment; in the order in which they came.
    void Receive(Moment at, Moment postedAt);
    // The knower's life ended, or the plot.
    void End(Moment at);

    struct Column
    {
        bool IsKnown = false;
        Moment Youngest = 0;
        Moment Oldest = 0;
    };
    const std::vector<Column> &Columns() const { return _columns; }
    std::size_t Values() const { return _values; }
    // What the age did not exceed for that part of the time, from 0 to 1, to some percent of it. 0 if no time
    // has passed.
    Moment Percentile(double part) const;
    Moment Oldest() const { return _oldest; }
    // When it was.
    Moment OldestAt() const { return _oldestAt; }

private:
    void Grow(Moment to);
    void AddToColumns(Moment from, Moment to);
    void AddToBins(Moment youngest, Moment oldest);

    const Moment _begin;
    const Moment _end;
    std::vector<Column> _columns;
    std::vector<double> _bins;  // of ages, each a little longer than the one before
    std::size_t _values = 0;
    std::optional<Moment> _postedAt;  // of what is known
    Moment _at = 0;                   // so far it is in columns and bins
    Moment _oldest = 0;
    Moment _oldestAt = 0;
};

}  // namespace Rabit::Merge
