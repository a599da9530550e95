#pragma once

#include <rabit/base/Backoff.h>
#include <rabit/gateway/RandomSource.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace Rabit
{

// Decides when this node sends which part of its announcement: once at the beginning, and again when nodes
// request it, once for all of them. Frequent requests lengthen the wait from one time to the next; so does
// the number of parts. The first request of an asker waits for NewAskerGap a part at most, however frequent
// those of others were: a program that starts anew each time, as a tool does, gets its answer.
//
// A pure state machine; `now` never goes back.
class OffersAnswer
{
public:
    using Duration = std::chrono::nanoseconds;

    // Wait from the end of one time to the next, for each part; it doubles.
    static constexpr Duration ShortestGap = std::chrono::milliseconds(50);
    static constexpr Duration LongestGap = std::chrono::seconds(2);
    // The first answers follow each other more quickly: an answer may be lost.
    static constexpr Duration QuickGap = std::chrono::milliseconds(100);
    static constexpr int QuickAnswers = 20;
    // Longest wait of the first request of an asker, for each part. Askers can be forged: three answers a
    // second are all that they get.
    static constexpr Duration NewAskerGap = std::chrono::milliseconds(300);
    // After this time without a question the gap is ShortestGap again.
    static constexpr Duration Quiet = std::chrono::seconds(5);
    // Time between two parts.
    static constexpr Duration PartGap = std::chrono::milliseconds(50);

    explicit OffersAnswer(RandomSource random) : _random(std::move(random)) {}

    // Begins to send the announcement, of `size` bytes.
    void Begin(std::size_t size);
    // A node lacks the announcement from byte `from` on. `others`: number of other nodes that may be asked at
    // the same moment. `asker`: tag of the incarnation that asks; empty: none does, and the wait is that of a
    // repeated request.
    void Asked(std::size_t from, std::size_t others, Duration now,
               std::optional<std::uint64_t> asker = std::nullopt);
    // When a part is to be sent; empty: none is.
    std::optional<Duration> Due() const { return _from ? std::optional(_at) : std::nullopt; }
    // The first byte of that part, and the number of bytes from there to the end.
    std::size_t From() const { return _from.value_or(0); }
    std::size_t Left() const { return _from ? _size - *_from : 0; }
    // `bytes` bytes of the announcement were sent. `delay` is the queueing delay of datagrams now: questions
    // that come within twice that time after the end were sent before it was heard, and are ignored.
    void Said(std::size_t bytes, Duration now, Duration delay = Duration(0));

private:
    // Askers that are remembered, the latest ones: more than a fleet has nodes.
    static constexpr std::size_t MostAskers = 256;

    bool IsNew(std::uint64_t asker);

    const RandomSource _random;
    std::size_t _size = 0;
    std::optional<std::size_t> _from;
    std::optional<std::size_t> _again;  // where to begin again once the end was sent
    bool _isAgainForNew = false;        // the first request of an asker is among those for _again
    Duration _at{0};
    Backoff _gap{{ShortestGap, LongestGap, 2.0, 0, QuickAnswers, QuickGap}};
    Duration _notBefore{0};
    Duration _notBeforeForNew{0};  // for the first request of an asker
    Duration _spreadUntil{0};      // of the first request since the last time
    std::deque<std::uint64_t> _askers;
    std::optional<Duration> _lastAsked;
    std::optional<Duration> _crossedUntil;  // until then questions are ignored
    int _parts = 0;                         // sent in the present round
};

}  // namespace Rabit
