// Three aircraft whose cameras look at a fully known world, and their tables of targets: no managers, no
// network, and no clock but the test's count of time.
#pragma once

#include "Geo.h"
#include "vision/Camera.h"
#include "vision/TargetTable.h"
#include "vision/World.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace SwarmTest
{

inline const Swarm::GeoPoint Middle{47.3977, 8.5456, 430};

// The faults of a flight.
struct TrackingScene
{
    double FalseAlarmsPerFrame = 0.05;  // on top of the camera's own
    double BiasM = 1.5;        // of an aircraft's own position: one standard deviation, north and east
    double MeanDelayS = 0.15;  // of a message between two aircraft
    double LateShare = 0.05;   // of messages, which take two seconds more
    double LostShare = 0.05;
    double AwayFromS = 200;  // one aircraft, which neither sees nor hears anything meanwhile
    double AwayToS = 380;
    double DeafFromS = 60;  // two aircraft do not hear each other
    double DeafToS = 150;
};

// Flies the scene of one seed. Aircraft search in lanes, and each circles one of the targets for a minute.
// Not thread-safe.
class TrackingFleet
{
public:
    static constexpr double StartS = 1.4e9;
    static constexpr double FrameS = 0.5;
    static constexpr int Aircraft = 3;

    TrackingFleet(std::uint64_t seed, Swarm::World world, const TrackingScene &scene = TrackingScene());

    // Returns six targets that stand or walk anywhere, and two whose ways cross.
    static Swarm::World RandomWorld(std::uint64_t seed);

    // Lets half a second pass: a frame of each camera, and the messages that arrive meanwhile.
    void Step();
    double TimeS() const { return _timeS; }  // since the start
    const Swarm::World &World() const { return _world; }
    bool IsAway(int aircraft) const;
    // Returns the report that the aircraft would publish now.
    Uav::Targets ReportOf(int aircraft) const;
    // Returns how many frames of the last `seconds` showed this target to the camera of any aircraft.
    int TimesSeen(std::size_t target, double seconds) const;

    static std::string NameOf(int aircraft) { return "uav" + std::to_string(aircraft + 1); }

private:
    struct Plane
    {
        std::unique_ptr<Swarm::TargetTable> Table;
        Swarm::Camera Camera{0};
        Swarm::Offset Bias{};
        double LanePhaseM = 0;  // how far along the lanes it began
        double CircleFromS = 0;
        Swarm::GeoPoint CircleAround{};
        std::uint32_t Frame = 0;
    };

    Uav::Pose PoseOf(const Plane &plane) const;
    void TakeFrame(int aircraft);
    void Send(int from, int to, const std::shared_ptr<const Rabit::RabitMessage> &message);
    void TellOthers(int aircraft);
    void Deliver();
    bool Hear(int a, int b) const;
    double Uniform(double from, double to);

    Swarm::World _world;
    TrackingScene _scene;
    std::mt19937_64 _random;
    std::vector<Plane> _planes;
    double _timeS = 0;
    std::uint64_t _sent = 0;
    // Messages by time of arrival; the number keeps those of one moment in order.
    std::map<std::pair<double, std::uint64_t>, std::pair<int, std::shared_ptr<const Rabit::RabitMessage>>>
        _underWay;
    std::vector<std::vector<double>> _seenS;  // of each target
};

}  // namespace SwarmTest
