#pragma once

#include <rabit/gateway/RandomSource.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace Rabit
{

// Decides when this node sends quick beats for newcomers. A newcomer must not wait for the next period; a
// crowd of newcomers, or one that comes again and again, must not make a whole fleet flood the channel. A
// newcomer for which no node sends quick beats has what it needs a period later.
//
// A pure state machine; `now` never goes back.
class Introductions
{
public:
    using Duration = std::chrono::nanoseconds;

    // One node gets quick beats once in this time for each reason, however often it comes.
    static constexpr Duration RestForOne = std::chrono::seconds(5);
    // All nodes together get quick beats MostInARow times in a row, and then once in RestForAll.
    static constexpr int MostInARow = 20;
    static constexpr Duration RestForAll = std::chrono::seconds(1);
    // Newcomers within this time are answered together.
    static constexpr Duration Together = std::chrono::milliseconds(10);

    enum class Reason
    {
        Appeared,  // the transport has found the node: it wants to hear of us, as soon as it can
        Heard      // its first beat of a life came: it can use what we publish
    };

    explicit Introductions(RandomSource random) : _random(std::move(random)) {}

    // A node has come. `others`: number of other nodes that hear of it at the same moment (Spread.h). Returns
    // true if this node sends quick beats for it.
    bool Ask(const std::string &node, Reason reason, std::size_t others, Duration now);
    // The same in two steps: Grant returns true if this node should send quick beats for that node, Begin
    // schedules them.
    bool Grant(const std::string &node, Reason reason, Duration now);
    void Begin(std::size_t others, Duration now);
    // When the next quick beats begin; empty: none are due.
    std::optional<Duration> Due() const { return _beatsAt; }
    // True, once, if it is time for the first of the quick beats.
    bool TakeBeats(Duration now);

private:
    const RandomSource _random;
    std::map<std::pair<std::string, Reason>, Duration> _asked;  // within RestForOne
    Duration _restedAt{0};                                      // nothing of MostInARow is used then
    std::optional<Duration> _beatsAt;
    std::optional<Duration> _last;
};

}  // namespace Rabit
