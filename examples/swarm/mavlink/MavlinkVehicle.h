#pragma once

#include "../Vehicle.h"
#include "ByteChannel.h"
#include "MavlinkFrame.h"
#include "MavlinkMessages.h"

#include <rabit/RabitTimer.h>

#include <memory>
#include <optional>

namespace Swarm
{

// An aircraft behind a real autopilot that speaks MAVLink (ArduPilot, PX4), as its companion computer.
//
// The first autopilot that sends a HEARTBEAT is used; others on the channel are ignored. Update returns
// each of its GLOBAL_POSITION_INT once, with the preceding attitude. A point to fly to is sent as
// SET_POSITION_TARGET_GLOBAL_INT, and repeated twice a second while it is valid. Frames get lost, and PX4
// otherwise leaves its offboard mode. The autopilot must be in a mode that obeys it, and flies at its own
// speed.
class MavlinkVehicle final : public Vehicle
{
public:
    // After this long without a heartbeat the autopilot counts as gone.
    static constexpr std::chrono::seconds SilentAfter{3};
    static constexpr std::uint8_t OwnComponent = 191;  // MAV_COMP_ID_ONBOARD_COMPUTER
    // Nearer than this to the point, the vehicle counts as holding there.
    static constexpr double ArrivedM = 25;

    explicit MavlinkVehicle(std::unique_ptr<ByteChannel> channel);

    void Start(Time now) override;
    std::optional<Motion> Update(Time now) override;
    // Not ready while no autopilot is heard.
    std::string NotReady(Time now) const override;
    void FlyTo(const GeoPoint &point, double speedMps, Time now) override;
    // Stops sending the point; the autopilot itself decides how to go on.
    void Release(Time /*now*/) override { _target.reset(); }
    Uav::FlightPhase Phase() const override;
    int DelayMSec(Time now) const override;

    bool IsHeard(Time now) const { return _system && now - _heardAt <= SilentAfter; }
    const MavlinkParser::Counters &Count() const { return _parser.Count(); }

private:
    void Take(const MavlinkFrame &frame, Time now);
    void TakeHeartbeat(const MavlinkFrame &frame, const MavlinkHeartbeat &heartbeat, Time now);
    void TakePosition(const MavlinkGlobalPosition &position);
    void SendTarget(Time now);
    void Send(MavlinkFrame frame);

    const std::unique_ptr<ByteChannel> _channel;
    MavlinkParser _parser;
    std::uint8_t _sequence = 0;
    Rabit::RabitTimer _heartbeats{std::chrono::seconds(1)};
    Rabit::RabitTimer _targets{std::chrono::milliseconds(500)};
    Time _startedAt{0};

    std::optional<std::uint8_t> _system;  // the autopilot's
    std::uint8_t _component = 0;
    Time _heardAt{0};
    Motion _motion;
    bool _news = false;  // a position came that Update has not returned yet
    bool _positionKnown = false;
    std::optional<GeoPoint> _target;
};

}  // namespace Swarm
