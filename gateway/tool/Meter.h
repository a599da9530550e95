#pragma once

#include <cstddef>
#include <vector>

namespace Rabit::Tool
{

// Statistics of the values that came from one node within a while. NaN if there were too few values.
class Meter
{
public:
    // Adds a value with its arrival time, in seconds, its bytes and its age. Times rise.
    void Add(double at, std::size_t bytes, double age);

    std::size_t Count() const { return _ages.size(); }
    // Values a second, between the first and the last value.
    double Rate() const;
    // Seconds between values: the shortest, the longest, and the standard deviation.
    double ShortestGap() const;
    double LongestGap() const;
    double Jitter() const;
    // Mean size of a value.
    double MeanBytes() const;
    // Returns the age that this part of the values (0 to 1) did not exceed; 1: the largest.
    double Age(double part) const;

private:
    std::vector<double> _gaps;
    std::vector<double> _ages;
    std::size_t _bytes = 0;
    double _first = 0.0;
    double _last = 0.0;
};

}  // namespace Rabit::Tool
