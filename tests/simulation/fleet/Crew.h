#pragma once

#include "AirOracle.h"
#include "FleetWorld.h"
#include "MirrorOracle.h"
#include "NoteOracle.h"
#include "PresenceOracle.h"

#include <rabit/RabitManager.h>

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway.idl.h"
#include "simulation.idl.h"

namespace Rabit::Sim
{

// The oracles that a Crew reports to.
struct Oracles
{
    NoteOracle &Notes;
    MirrorOracle &Mirrors;
    PresenceOracle &Presence;
    AirOracle &Air;
    // The reading that the monotonic clock of the process of that life has now.
    std::function<Time(std::size_t life)> ClockOf;
};

// The manager of a simulated node that does what users' managers do: posts, fetches what others posted, sends
// notes to others, and takes those that came out of its queue, at its own pace.
class Crew : public RabitManager
{
public:
    static constexpr const char *Queue = "Notes";

    Crew(RabitWorkspace &workspace, FleetWorld &world, const Oracles &oracles, SimRandom &random,
         std::size_t life);
    ~Crew() override;

    void ExecuteUnitOfWork() override;

    // For the next unit of work, which follows at once.
    void Send(std::size_t destination, int count);
    void PostMode();
    // Nothing is taken out of the queue until then (true time).
    void StallUntil(Time until) { _stalledUntil = until; }
    // From now on it takes notes as they come.
    void Hurry();
    // From now on it posts no tracks.
    void FallSilent() { _silent = true; }
    // Tells the oracle what is in the queue: at the end of the process.
    void EmptyQueue();
    // The state of the fleet, as of the last fetch.
    const Gateway::Fleet &Fleet() const { return *_fleet; }

private:
    template <typename Message>
    struct Mirror
    {
        std::size_t Node = 0;
        std::shared_ptr<Message> Local;
    };

    template <typename Message>
    void AddMirrors(const char *name, std::vector<Mirror<Message>> &mirrors);
    template <typename Message>
    void FetchMirrors(MirrorOracle::Topic topic, std::vector<Mirror<Message>> &mirrors);
    void NoteArrivals();
    bool TakeOne();
    void SendNotes();
    Time LocalNow() const { return GetWorkspace().GetClock().Monotonic(); }

    FleetWorld &_world;
    Oracles _oracles;
    SimRandom &_random;
    const std::size_t _life;
    const MachinePlan &_plan;
    std::shared_ptr<RabitQueue> _queue;
    struct Arrival
    {
        Time At{0};                      // true time
        std::vector<Time> SourceClocks;  // by life; what each sender's clock showed
    };
    std::deque<Arrival> _arrivals;  // of what is in the queue
    std::shared_ptr<Track> _track;
    std::shared_ptr<Mode> _mode;
    std::shared_ptr<Gateway::Fleet> _fleet;
    std::vector<Mirror<Track>> _tracks;
    std::vector<Mirror<Mode>> _modes;
    std::vector<std::pair<std::size_t, int>> _orders;
    bool _postMode = false;
    Time _nextTrack{0};
    Time _nextTake{0};
    Time _stalledUntil{0};
    bool _hurries = false;
    bool _silent = false;
};

}  // namespace Rabit::Sim
