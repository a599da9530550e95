#pragma once

#include "FleetWorld.h"

#include <rabit/simulated/SimulatedNetwork.h>

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "gateway.idl.h"

namespace Rabit::Sim
{

// Knows the rate of the medium if the plan has a thin one, and hears the traffic on it. Fails if the fleet
// does not hold together over it, shows old tracks, or sends too much. For other plans it checks nothing.
class AirOracle
{
public:
    AirOracle(FleetWorld &world, const SimulatedNetwork &network);

    void OnStarted(std::size_t node);
    void OnEnded(std::size_t node);
    void OnOutage();
    void OnOutageEnd();
    void OnRate(std::uint64_t bytesPerSecond);

    // Checks the traffic on the air after each step of the simulation.
    void OnStep();
    // The gateway of a life shows this fleet now.
    void OnFleet(std::size_t observerLife, const Gateway::Fleet &fleet);
    // A track of this age (true time) has come.
    void OnTrack(std::size_t observerLife, std::size_t node, Time age);
    // A large note of this node waits or is on its way.
    void OnLargeNotes(std::size_t node) { _senders[node].LargeAt = _world.Now; }
    // The newest track that an observer has of a live node has this age. Called now and then.
    void OnNewestTrack(std::size_t observer, std::size_t node, Time age);
    // Adds work: the bytes on the air of a message if it were sent once.
    void OnWork(std::uint64_t bytes) { _work += bytes; }
    // From here to EndIdle nothing is posted or sent: all traffic is that of idle nodes.
    void BeginIdle();
    void EndIdle();

    std::uint64_t LongestTrackAge() const { return static_cast<std::uint64_t>(_longestAge.count()); }
    // The most bytes sent, in percent of the bytes allowed.
    std::uint64_t MostSaid() const { return _mostSaid; }
    std::uint64_t LongestUntilUp() const { return static_cast<std::uint64_t>(_longestUntilUp.count()); }

private:
    // The state of a node that an observer must show.
    struct Pair
    {
        Time Since{0};  // they can hear each other from here on
        bool WasUp = false;
        bool Counts = false;  // both are there, and nothing is in the way
        // Lives: the one shown last, and the one that has ended. Its goodbye may still be under way.
        std::uint64_t Shown = 0;
        std::uint64_t Ended = 0;
    };
    // The bytes that a node has sent in the last second.
    struct Sender
    {
        bool Alive = false;
        SimulatedSent Last;
        std::deque<std::pair<Time, std::uint64_t>> Second;  // when, bytes
        std::uint64_t Bytes = 0;                            // of those
        Time AdaptedAt{0};                                  // to the present rate of the medium
        std::optional<Time> LargeAt;                        // a large note was seen to wait
        bool MayFlood = false;  // the medium has become slower, and this node could not see it yet
    };

    Pair &PairOf(std::size_t observer, std::size_t node) { return _pairs[observer * _senders.size() + node]; }
    // From `since` on the node can hear, or cannot.
    void Restart(std::size_t node, Time since);
    void CheckBudget(std::size_t node);
    Time TimeOf(std::uint64_t bytes) const;
    void LookForFlood(Sender &sender, const SimulatedSent &sent) const;
    Time WhenAdapted() const;
    std::uint64_t Total() const;
    void SayWhatIsSent();

    FleetWorld &_world;
    const SimulatedNetwork &_network;
    const std::optional<ThinPlan> &_plan;
    std::vector<Pair> _pairs;
    std::vector<Sender> _senders;
    bool _outage = false;
    std::uint64_t _rate = 0;
    Time _discoverySince{0};  // something made DDS find somebody
    Time _outageSince{0};
    std::uint64_t _starts = 0;
    std::uint64_t _work = 0;
    std::uint64_t _sentBeforeIdle = 0;
    Time _idleSince{0};
    Time _saidAt{0};
    std::vector<SimulatedSent> _said;  // by node
    std::uint64_t _mostSaid = 0;
    Time _longestAge{0};
    Time _longestUntilUp{0};
};

}  // namespace Rabit::Sim
