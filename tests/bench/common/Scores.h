#pragma once

#include "BenchOptions.h"
#include "Usage.h"

#include <cstdint>
#include <vector>

namespace Rabit::Bench
{

// What one side of a run has measured. Each prints one line of JSON when it is complete, at once, so that the
// process may then be ended by a signal. A time or count is for one message; with round trips, which are two
// messages, half a round trip is what one message took. One thread at a time.

// Who sends the pings.
class PingScore
{
public:
    explicit PingScore(const BenchOptions &options);
    // The answer to the message of that number has come after so long, or (negative) never.
    void Add(std::uint64_t number, std::int64_t roundTrip);
    bool IsComplete() const { return _complete; }

private:
    void Print() const;

    const BenchOptions _options;
    std::vector<std::int64_t> _roundTrips;
    std::uint64_t _lost = 0;
    Usage _before;
    bool _complete = false;
};

// Who receives: what it has used between the first and the last message that count, how fast they came, and
// whether each came once and in order.
class ReceiverScore
{
public:
    explicit ReceiverScore(const BenchOptions &options) : _options(options) {}
    void Add(std::uint64_t number);
    bool IsComplete() const { return _complete; }

private:
    void Print() const;

    const BenchOptions _options;
    std::uint64_t _last = 0;
    std::uint64_t _received = 0;  // that count
    std::uint64_t _outOfOrder = 0;
    std::int64_t _begin = 0;
    Usage _before;
    bool _begun = false;
    bool _complete = false;
};

// Who sends as fast as it goes.
class SourceScore
{
public:
    explicit SourceScore(const BenchOptions &options) : _options(options) {}
    // The message of that number is about to be sent.
    void Sending(std::uint64_t number);
    // All were acknowledged.
    void Complete();

private:
    const BenchOptions _options;
    std::int64_t _begin = 0;
    Usage _before;
};

}  // namespace Rabit::Bench
