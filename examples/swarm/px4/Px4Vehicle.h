#pragma once

#include "../Vehicle.h"

#include <rabit/RabitTimer.h>
#include <rabit/RabitWorkspace.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "px4_msgs/msg/VehicleAttitude.idl.h"
#include "px4_msgs/msg/VehicleCommand.idl.h"
#include "px4_msgs/msg/VehicleCommandAck.idl.h"
#include "px4_msgs/msg/VehicleGlobalPosition.idl.h"
#include "px4_msgs/msg/VehicleLocalPosition.idl.h"
#include "px4_msgs/msg/VehicleStatus.idl.h"

namespace Swarm
{

// An aircraft whose PX4 speaks DDS, through its agent (uXRCE-DDS). It uses only local messages: it reads
// Px4/Status, Px4/Position, Px4/LocalPosition, Px4/Attitude and Px4/Ack, and posts Px4/Command. The gateway
// joins them to PX4's topics; AddPx4Topics (Px4Topics.h) configures that.
//
// Update returns each position once, with the preceding velocity and attitude. A point to fly to is sent as
// the command DO_REPOSITION, after which PX4 holds there in its hold mode. The command is repeated each
// second until PX4 answers, at most three times. PX4 must be armed and in the air.
class Px4Vehicle final : public Vehicle
{
public:
    // After this long without a status PX4 counts as gone.
    static constexpr double SilentAfterS = 3;
    // Time for which NotReady reports that, and why, PX4 refused a point.
    static constexpr std::chrono::seconds RefusalShown{5};
    // Nearer than this to the point, the vehicle counts as holding there.
    static constexpr double ArrivedM = 25;
    static constexpr int MostAttempts = 3;

    // The workspace must outlive the object.
    explicit Px4Vehicle(Rabit::RabitWorkspace &workspace);

    void Start(Time /*now*/) override {}
    std::optional<Motion> Update(Time now) override;
    // Not ready while PX4 is not heard, not armed or without a position, and for a while after it refused a
    // point.
    std::string NotReady(Time now) const override;
    void FlyTo(const GeoPoint &point, double speedMps, Time now) override;
    // Stops sending: PX4 flies on to the last point, and holds there.
    void Release(Time /*now*/) override;
    Uav::FlightPhase Phase() const override;
    int DelayMSec(Time now) const override;

private:
    bool IsHeard() const;
    bool IsArmed() const;
    void TakeMotion();
    void TakeAnswer(Time now);
    void SendCommand(Time now);

    const std::shared_ptr<px4_msgs::msg::VehicleStatus> _status =
        std::make_shared<px4_msgs::msg::VehicleStatus>();
    const std::shared_ptr<px4_msgs::msg::VehicleGlobalPosition> _position =
        std::make_shared<px4_msgs::msg::VehicleGlobalPosition>();
    const std::shared_ptr<px4_msgs::msg::VehicleLocalPosition> _local =
        std::make_shared<px4_msgs::msg::VehicleLocalPosition>();
    const std::shared_ptr<px4_msgs::msg::VehicleAttitude> _attitude =
        std::make_shared<px4_msgs::msg::VehicleAttitude>();
    const std::shared_ptr<px4_msgs::msg::VehicleCommandAck> _answer =
        std::make_shared<px4_msgs::msg::VehicleCommandAck>();
    const std::shared_ptr<px4_msgs::msg::VehicleCommand> _command =
        std::make_shared<px4_msgs::msg::VehicleCommand>();

    Motion _motion;
    bool _hasPosition = false;  // in PX4's last position message
    std::optional<GeoPoint> _target;
    double _speedMps = 0;
    bool _awaitsAnswer = false;
    int _attempts = 0;  // attempts left for the command
    Rabit::RabitTimer _repeats{std::chrono::seconds(1)};
    std::string _refusal;
    Time _refusedAt{0};
};

}  // namespace Swarm
