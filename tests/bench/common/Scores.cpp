#include "Scores.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace Rabit::Bench
{
namespace
{

std::int64_t Quantile(const std::vector<std::int64_t> &sorted, double share)
{
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

double Seconds(std::int64_t nanoseconds)
{
    return static_cast<double>(nanoseconds) * 1e-9;
}

// Prints the line in one piece: two managers of one process may be done at the same time.
void PrintLine(const std::string &line)
{
    const std::string text = line + '\n';
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
}

}  // namespace

PingScore::PingScore(const BenchOptions &options) : _options(options)
{
    _roundTrips.reserve(options.Count);
}

void PingScore::Add(std::uint64_t number, std::int64_t roundTrip)
{
    if (number == _options.WarmUp)
    {
        _before = Usage::Take();
    }
    if (number > _options.WarmUp && number <= _options.Last())
    {
        if (roundTrip < 0)
        {
            ++_lost;
        }
        else
        {
            _roundTrips.push_back(roundTrip);
        }
    }
    if (number == _options.Last() && !_complete)
    {
        _complete = true;
        Print();
    }
}

void PingScore::Print() const
{
    const Usage after = Usage::Take();
    std::ostringstream out;
    out << "{\"lost\": " << _lost << ", " << PerMessage(_before, after, _options.Count);
    if (!_roundTrips.empty())
    {
        std::vector<std::int64_t> sorted = _roundTrips;
        std::sort(sorted.begin(), sorted.end());
        out << ", \"p50_ns\": " << Quantile(sorted, 0.5) / 2 << ", \"p99_ns\": " << Quantile(sorted, 0.99) / 2
            << ", \"p999_ns\": " << Quantile(sorted, 0.999) / 2 << ", \"min_ns\": " << sorted.front() / 2;
    }
    out << "}";
    PrintLine(out.str());
}

void ReceiverScore::Add(std::uint64_t number)
{
    if (!_begun && number >= _options.WarmUp && number > 0)
    {
        _begun = true;
        _begin = Now();
        _before = Usage::Take();
    }
    else if (number > _options.WarmUp && number <= _options.Last())
    {
        ++_received;
    }
    _outOfOrder += number > 0 && number <= _last ? 1 : 0;
    _last = std::max(_last, number);
    if (number >= _options.Last() && !_complete)
    {
        _complete = true;
        Print();
    }
}

void ReceiverScore::Print() const
{
    const std::int64_t end = Now();
    std::ostringstream out;
    out << "{\"received\": " << _received << ", \"missed\": " << _options.Count - _received
        << ", \"out_of_order\": " << _outOfOrder << ", \"seconds\": " << Seconds(end - _begin) << ", "
        << PerMessage(_before, Usage::Take(), _options.Count) << "}";
    PrintLine(out.str());
}

void SourceScore::Sending(std::uint64_t number)
{
    if (number == _options.WarmUp + 1)
    {
        _begin = Now();
        _before = Usage::Take();
    }
}

void SourceScore::Complete()
{
    const std::int64_t end = Now();
    std::ostringstream out;
    out << "{\"seconds\": " << Seconds(end - _begin) << ", "
        << PerMessage(_before, Usage::Take(), _options.Count) << "}";
    PrintLine(out.str());
}

}  // namespace Rabit::Bench
