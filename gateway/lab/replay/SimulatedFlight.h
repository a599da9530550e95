#pragma once

#include <rabit/testing/SimulatedFleet.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "FlightTap.h"
#include "Recording.h"
#include "recording/replay/PostTimes.h"

namespace Rabit::WhatIf
{

struct FlightSettings
{
    SimulatedMedium Medium{};
    SimulatedFaults Faults{};
    // Replaces the budgets of all nodes, in bytes a second; 0: as the channel allows.
    std::optional<double> Budget{};
    std::uint64_t Seed = 1;
};

// Flies a recorded flight once more over another radio, in simulated time: each node posts and sends what it
// did, when it did. One thread; equal recordings and settings give equal facts.
class SimulatedFlight
{
public:
    using Json = nlohmann::ordered_json;
    using Tell = std::function<void(Json)>;

    // The recording must outlive the object.
    SimulatedFlight(Recording &recording, const FlightSettings &settings, Tell tell);
    ~SimulatedFlight();

    // Flies it to its end. Tells the facts of lab_facts (../facts/FlightFile.h), those of the recording
    // (RecordedFacts.h), and those below; "t" and all other times are nanoseconds since the beginning.
    //   {"fact": "values", ...}                        once for each message of a life, also of its own
    //   {"fact": "queue", "from": NODE, "to": NODE, "queue": NAME, "sent": COUNT, "refused": COUNT,
    //    "outcomes": {OUTCOME: COUNT}, "ages": [NS...]}
    //   {"fact": "medium", "t": NS, "bytes": COUNT, "carried": COUNT, "dropped": COUNT, "longest_wait": NS}
    // Throws ConfigError.
    void Run();

private:
    struct Flying;

    void Start(std::size_t life);
    void End(std::size_t life, bool isCrash);
    void Play(const Replay::ReplayItem &item);
    void RunTo(Time time);
    void TellOf(const Flying &flying, Json fact);
    void TellMedium();
    void TellQueues();
    std::int64_t Since(Time time) const { return static_cast<std::int64_t>(time - _begin); }

    Recording &_recording;
    const FlightSettings _settings;
    const Tell _tell;
    const std::shared_ptr<QueueBook> _book = std::make_shared<QueueBook>();
    Replay::PostTimes _times;
    const Time _begin;
    const Time _end;
    Nanoseconds _nextMedium{0};
    SimulatedFleet _fleet;
    std::vector<std::unique_ptr<Flying>> _lives;  // in the recording's order; null: it is not there
    std::map<std::string, std::size_t> _there;    // node to life
};

}  // namespace Rabit::WhatIf
