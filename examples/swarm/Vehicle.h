#pragma once

#include "Flight.h"
#include "Geo.h"

#include <chrono>
#include <optional>
#include <string>

namespace Swarm
{

// The aircraft behind the manager Autopilot: simulated, or a real one with an autopilot. Used by one
// thread. Times are of the workspace's monotonic clock.
class Vehicle
{
public:
    using Time = std::chrono::nanoseconds;

    virtual ~Vehicle() = default;

    // Starts the vehicle; called once, before all other methods.
    virtual void Start(Time now) = 0;
    // The current motion, if there is a new one; never the same motion twice.
    virtual std::optional<Motion> Update(Time now) = 0;
    // The reason why it would not fly to a point now; empty if it would.
    virtual std::string NotReady(Time now) const = 0;
    // Flies to the point, at that speed (m/s, above 0) if it can choose its speed, and stays there. Does
    // nothing if it is not ready.
    virtual void FlyTo(const GeoPoint &point, double speedMps, Time now) = 0;
    // Ends the flight to a point: back to its own track or pattern, if it has one.
    virtual void Release(Time now) = 0;
    // The phase of flight, as of the last call of Update, FlyTo or Release.
    virtual Uav::FlightPhase Phase() const = 0;
    // Milliseconds to wait before the next Update.
    virtual int DelayMSec(Time now) const = 0;
};

}  // namespace Swarm
