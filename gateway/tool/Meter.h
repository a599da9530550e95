#pragma once

#include <cstddef>
#include <vector>

namespace Rabit::Tool
{

// What arrived of one node within a while, put into numbers. Numbers are NaN where there were too few values.
class Meter
{
public:
    // A value came at that time; of so many bytes, of that age. Times rise.
    void Add(double at, std::size_t bytes, double age);

    std::size_t Count() const { return _ages.size(); }
    // Values a second, between the first and the last.
    double Rate() const;
    // Between values: the shortest, the longest, and the standard deviation; seconds.
    double ShortestGap() const;
    double LongestGap() const;
    double Jitter() const;
    // Of one value on average.
    double MeanBytes() const;
    // The age that this part of the values (0 to 1) did not exceed; 1: the largest.
    double Age(double part) const;

private:
    std::vector<double> _gaps;
    std::vector<double> _ages;
    std::size_t _bytes = 0;
    double _first = 0.0;
    double _last = 0.0;
};

}  // namespace Rabit::Tool
