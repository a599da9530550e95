#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "recording/merge/Moment.h"

namespace Rabit::Merge
{

// The age of a message, as a node knew it, over time: it grows with time, and falls when a newer value
// comes. Memory is bounded, whatever the length: it keeps the range of ages in each column of a plot, and
// how much time was spent at which age. Not thread-safe.
class AgeHistory
{
public:
    // For a plot of that time with that number of columns, one at least. Ages outside of that time are not
    // plotted.
    AgeHistory(Moment begin, Moment end, std::size_t columns);

    // A value that was posted at `postedAt` came at `at`. To be called in the order in which values came.
    void Receive(Moment at, Moment postedAt);
    // The life of the knowing node, or the plot, ended.
    void End(Moment at);

    struct Column
    {
        bool IsKnown = false;
        Moment Youngest = 0;
        Moment Oldest = 0;
    };
    const std::vector<Column> &Columns() const { return _columns; }
    std::size_t Values() const { return _values; }
    // Returns the age that was not exceeded for that part of the time, from 0 to 1, to within 2.4 % of the
    // age at worst: within a bin it is interpolated. 0 if no time has passed.
    Moment Percentile(double part) const;
    Moment Oldest() const { return _oldest; }
    // The moment of the oldest age.
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
    std::optional<Moment> _postedAt;  // of the known value
    Moment _at = 0;                   // columns and bins are complete up to here
    Moment _oldest = 0;
    Moment _oldestAt = 0;
};

}  // namespace Rabit::Merge
