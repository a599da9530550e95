#pragma once

#include <rabit/gateway/RandomSource.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace Rabit
{

// Decides when this node speaks up for those who have just come, with beats that follow each other quickly: a
// newcomer must not wait for the next period, and a crowd of newcomers, or one that comes again and again,
// must not make a whole fleet shout. Whom nobody speaks up for has what it needs a period later.
//
// A pure state machine; `now` never goes back.
class Introductions
{
public:
    using Duration = std::chrono::nanoseconds;

    // For one node this node speaks up once in this time for each reason, however often the node comes.
    static constexpr Duration RestForOne = std::chrono::seconds(5);
    // For all together: as often as this in a row, and then once in that time.
    static constexpr int MostInARow = 20;
    static constexpr Duration RestForAll = std::chrono::seconds(1);
    // Those who come as close together as this are answered together.
    static constexpr Duration Together = std::chrono::milliseconds(10);

    enum class Reason
    {
        Appeared,  // the transport has found the node: it wants to hear of us, as soon as it can
        Heard      // its first beat of a life came: it can use what we publish
    };

    explicit Introductions(RandomSource random) : _random(std::move(random)) {}

    // A node has come. `others`: nodes that know of it as well; all of them hear of it at the same moment
    // (Spread.h). Returns whether this node speaks up for it.
    bool Ask(const std::string &node, Reason reason, std::size_t others, Duration now);
    // The same in two steps: whether this node speaks up for that one, and that it is to do so now.
    bool Grant(const std::string &node, Reason reason, Duration now);
    void Begin(std::size_t others, Duration now);
    // When this node speaks up next; empty: for nobody.
    std::optional<Duration> Due() const { return _beatsAt; }
    // Whether it is time for the first beat. Says so once.
    bool TakeBeats(Duration now);

private:
    const RandomSource _random;
    std::map<std::pair<std::string, Reason>, Duration> _asked;  // within RestForOne
    Duration _restedAt{0};                                      // nothing of MostInARow is used then
    std::optional<Duration> _beatsAt;
    std::optional<Duration> _last;
};

}  // namespace Rabit
