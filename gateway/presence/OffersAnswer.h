#pragma once

#include <rabit/gateway/RandomSource.h>

#include <chrono>
#include <cstddef>
#include <optional>

namespace Rabit
{

// When this node says which part of its announcement: once at the beginning, and again for who asks, to all
// of them together. The more often it is asked the longer it waits from one time to the next, and the longer
// the more parts there are.
//
// A pure state machine; `now` never goes back.
class OffersAnswer
{
public:
    using Duration = std::chrono::nanoseconds;

    // From the end of one time to the next, for each part; the gap doubles.
    static constexpr Duration ShortestGap = std::chrono::milliseconds(50);
    static constexpr Duration LongestGap = std::chrono::seconds(2);
    // The first answers follow each other more quickly: an answer may be lost.
    static constexpr Duration QuickGap = std::chrono::milliseconds(300);
    static constexpr int QuickAnswers = 12;
    // After so long without a question it is short again.
    static constexpr Duration Quiet = std::chrono::seconds(5);
    // Between parts.
    static constexpr Duration PartGap = std::chrono::milliseconds(50);

    explicit OffersAnswer(RandomSource random) : _random(std::move(random)) {}

    // The announcement has so many bytes; it is to be said.
    void Begin(std::size_t size);
    // Somebody lacks it from that byte on. `others`: nodes that may be asked at the same moment.
    void Asked(std::size_t from, std::size_t others, Duration now);
    // When a part is to be said; empty: none is.
    std::optional<Duration> Due() const { return _from ? std::optional(_at) : std::nullopt; }
    // The first byte of that part, and the bytes that are left from there.
    std::size_t From() const { return _from.value_or(0); }
    std::size_t Left() const { return _from ? _size - *_from : 0; }
    // So many bytes of it were said. `delay` is how long datagrams wait in queues now: questions that come
    // within twice that time were sent before this was heard, and are ignored.
    void Said(std::size_t bytes, Duration now, Duration delay = Duration(0));

private:
    const RandomSource _random;
    std::size_t _size = 0;
    std::optional<std::size_t> _from;
    std::optional<std::size_t> _again;  // where to begin once the end is said
    Duration _at{0};
    Duration _gap = ShortestGap;
    int _answers = 0;  // since the gap was short
    Duration _notBefore{0};
    std::optional<Duration> _lastAsked;
    std::optional<Duration> _crossedUntil;  // until then questions are ignored
    int _parts = 0;                         // said of the present time
};

}  // namespace Rabit
