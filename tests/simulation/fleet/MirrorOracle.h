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

// Knows what was posted where and when, and says if what another node sees of it goes back, was never posted,
// or looks younger than it is.
class MirrorOracle
{
public:
    // What an age may be wrong by: half the round trip, for nobody can tell the delays of the two directions
    // apart.
    static constexpr Time AgeTolerance = std::chrono::milliseconds(1300);
    // Over a thin medium the paths are short, and without a budget of the smallest, with which round trips
    // are measured seldom, it is no more than the wait for the medium. Until so long after somebody came or
    // the medium changed, a quarter of what a full queue of each node takes in addition: all beats may have
    // waited in queues for some seconds then, and a gateway forgets the quickest of before after 15 to 30
    // seconds.
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
    // A life fetched something new that it takes for a value of `node`.
    void OnFetched(Topic topic, std::size_t observerLife, std::size_t node, std::uint64_t life,
                   std::uint64_t number, double ageSeconds);
    // Whether that life has the newest value of a node's present life (or it has posted none).
    bool IsUpToDate(Topic topic, std::size_t observerLife, std::size_t life) const;
    // How old the value is that it has; the longest time if none of that life.
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
