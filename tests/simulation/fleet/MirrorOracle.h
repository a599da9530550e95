#pragma once

#include "FleetWorld.h"

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "simulation.idl.h"

namespace Rabit::Sim
{

// Knows all posted values. Fails if a mirrored value goes back, was never posted, or looks younger than it
// is.
class MirrorOracle
{
public:
    // Largest error of an age: half the round trip, as the delays of the two directions cannot be told
    // apart.
    static constexpr Time AgeTolerance = std::chrono::milliseconds(1300);
    // The same over a thin medium with short paths: at most the wait for the medium. The smallest budget is
    // an exception, since round trips are measured seldom with it. For `Settles` after a node came or the
    // medium changed, a quarter of the time of all full queues is added. All beats may have waited in queues
    // for some seconds then, and a gateway forgets the quickest earlier one after 15 to 30 seconds.
    static constexpr Time ThinAgeTolerance = std::chrono::milliseconds(300);
    static constexpr Time Settles = std::chrono::seconds(45);

    enum class Topic
    {
        Track,
        Mode
    };

    explicit MirrorOracle(FleetWorld &world) : _world(world) {}

    // A life posts its next value; returns its number.
    std::uint64_t OnPosted(Topic topic, std::size_t life);
    // A life fetched something new, attributed to `node`.
    void OnFetched(Topic topic, std::size_t observerLife, std::size_t node, std::uint64_t life,
                   std::uint64_t number, double ageSeconds);
    // True if the observer has the newest value of this life (or the life has posted none).
    bool IsUpToDate(Topic topic, std::size_t observerLife, std::size_t life) const;
    // Returns the age of the observer's value of this life; the longest time if it has none.
    Time AgeOf(Topic topic, std::size_t observerLife, std::size_t life) const;

    std::uint64_t Fetched(Topic topic) const { return _fetched[static_cast<std::size_t>(topic)]; }

private:
    Time Tolerance() const;

    static constexpr std::size_t Topics = 2;
    struct Seen
    {
        std::uint64_t Life = 0;
        std::uint64_t Number = 0;
        bool Anything = false;
    };

    FleetWorld &_world;
    std::map<std::pair<Topic, std::size_t>, std::deque<Time>> _posts;  // by topic and life: true times
    std::map<std::pair<Topic, std::pair<std::size_t, std::size_t>>, Seen> _seen;  // observer's life, node
    std::uint64_t _fetched[Topics] = {};
};

}  // namespace Rabit::Sim
