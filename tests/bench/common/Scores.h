#pragma once

#include "BenchOptions.h"
#include "Usage.h"

#include <cstdint>
#include <vector>

namespace Rabit::Bench
{

// The scores of the sides of a run. Each prints one line of JSON as soon as it is complete, so that a
// signal may then end the process. Times and counts are for one message; of a round trip, which is two
// messages, half counts. One thread at a time.

// The score of the side that sends the pings.
class PingScore
{
public:
    explicit PingScore(const BenchOptions &options);
    // The answer to message `number` has come after `roundTrip`, or (negative) never.
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

// The score of the receiver: its resource use and the rate between the first and the last counted message,
// and whether each message came once and in order.
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

// The score of the side that sends as fast as it can.
class SourceScore
{
public:
    explicit SourceScore(const BenchOptions &options) : _options(options) {}
    // Message `number` is about to be sent.
    void Sending(std::uint64_t number);
    // All messages were acknowledged.
    void Complete();

private:
    const BenchOptions _options;
    std::int64_t _begin = 0;
    Usage _before;
};

}  // namespace Rabit::Bench
