#pragma once

#include "Flight.h"
#include "Geo.h"

#include <chrono>
#include <optional>
#include <string>

namespace Swarm
{

// The aircraft as the manager Autopilot sees it: simulated, or a real one behind an autopilot. Used by one
// thread. Times are of the workspace's monotonic clock.
class Vehicle
{
public:
    using Time = std::chrono::nanoseconds;

    virtual ~Vehicle() = default;

    // The vehicle begins to live; called once, before anything else.
    virtual void Start(Time now) = 0;
    // How it moves, if there is something to tell that was not told before: never an old motion again.
    virtual std::optional<Motion> Update(Time now) = 0;
    // Why it would not fly to a point now; empty if it would.
    virtual std::string NotReady(Time now) const = 0;
    // Flies to the point, at that speed (m/s, above 0) if it can choose its speed, and stays there. Does
    // nothing if it is not ready.
    virtual void FlyTo(const GeoPoint &point, double speedMps, Time now) = 0;
    // No point any more: back to what it flies of its own accord, if there is anything.
    virtual void Release(Time now) = 0;
    // What it is doing, as of the last call of Update, FlyTo or Release.
    virtual FlightPhase Phase() const = 0;
    // How long to wait before the next Update, in milliseconds.
    virtual int DelayMSec(Time now) const = 0;
};

}  // namespace Swarm
