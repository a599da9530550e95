#pragma once

#include "Vehicle.h"

#include <rabit/RabitTimer.h>

#include <chrono>

namespace Swarm
{

// A simulated aircraft: flies a Flight, and gives a new motion ten times a second.
class SimulatedVehicle final : public Vehicle
{
public:
    static constexpr std::chrono::milliseconds Period{100};

    explicit SimulatedVehicle(Flight flight) : _flight(std::move(flight)) {}

    void Start(Time now) override { _start = now; }
    std::optional<Motion> Update(Time now) override
    {
        const Motion motion = _flight.At(SecondsAt(now));
        return _times.IsDue(now) ? std::optional<Motion>(motion) : std::nullopt;
    }
    std::string NotReady(Time /*now*/) const override { return ""; }
    void FlyTo(const GeoPoint &point, double speedMps, Time now) override
    {
        _flight.FlyTo(point, speedMps, SecondsAt(now));
    }
    void Release(Time now) override { _flight.Release(SecondsAt(now)); }
    Uav::FlightPhase Phase() const override { return _flight.Phase(); }
    int DelayMSec(Time now) const override
    {
        return static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(_times.UntilDue(now)).count());
    }

private:
    double SecondsAt(Time now) const { return std::chrono::duration<double>(now - _start).count(); }

    Flight _flight;
    Rabit::RabitTimer _times{Period};
    Time _start{0};
};

}  // namespace Swarm
