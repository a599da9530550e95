#pragma once

#include <cstddef>
#include <vector>

namespace Rabit::Tool
{

// Round trips to a node, in seconds.
class RoundTrips
{
public:
    // A request went out, and its answer came, or did not.
    void Answered(double seconds);
    void Lost() { ++_lost; }

    std::size_t Sent() const { return _sorted.size() + _lost; }
    std::size_t Came() const { return _sorted.size(); }
    // Share of the requests without an answer. NaN if there was no request.
    double Loss() const;
    // The smallest one that at least this share of all does not exceed; 0: the smallest, 1: the largest. NaN
    // if none came.
    double Percentile(double share) const;

private:
    std::vector<double> _sorted;
    std::size_t _lost = 0;
};

}  // namespace Rabit::Tool
