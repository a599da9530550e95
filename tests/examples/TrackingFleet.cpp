#include "TrackingFleet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace SwarmTest
{
namespace
{
constexpr double GroundM = 430;
constexpr double HeightM = 80;
constexpr double AreaNorthM = 300;
constexpr double AreaEastM = 400;
constexpr double LaneM = 50;
constexpr double SpeedMps = 16;
constexpr double CircleM = 35;
constexpr double CircleS = 60;
constexpr double LateS = 2;

Swarm::WorldTarget Walker(const Swarm::Offset &from, double speedMps, double headingRad, double lengthM)
{
    Swarm::WorldTarget target;
    target.Start = Swarm::Moved(Middle, from);
    target.SpeedMps = speedMps;
    target.HeadingRad = headingRad;
    target.LengthM = lengthM;
    return target;
}

// Returns the place and heading after `wayM` metres along the lanes. After the last lane the first begins
// again.
std::pair<Swarm::Offset, double> OnLanes(double wayM)
{
    const auto lanes = static_cast<int>(AreaNorthM / LaneM);
    const double round = lanes * AreaEastM;
    const double left = std::fmod(wayM, round);
    const int lane = static_cast<int>(left / AreaEastM);
    const double along = left - lane * AreaEastM;
    const bool east = lane % 2 == 0;
    return {{-AreaNorthM / 2 + LaneM * (lane + 0.5), east ? along - AreaEastM / 2 : AreaEastM / 2 - along, 0},
            (east ? 0.5 : -0.5) * std::numbers::pi};
}
}  // namespace

TrackingFleet::TrackingFleet(std::uint64_t seed, Swarm::World world, const TrackingScene &scene)
    : _world(std::move(world)), _scene(scene), _random(seed), _seenS(_world.Targets.size())
{
    std::normal_distribution<double> bias(0, _scene.BiasM);
    for (int i = 0; i < Aircraft; ++i)
    {
        Plane plane;
        plane.Table = std::make_unique<Swarm::TargetTable>(NameOf(i));
        plane.Camera = Swarm::Camera(_random());
        plane.Bias.NorthM = bias(_random);
        plane.Bias.EastM = bias(_random);
        plane.LanePhaseM = AreaNorthM / LaneM * AreaEastM * i / Aircraft;
        plane.CircleFromS = Uniform(60, 500);
        const auto target =
            static_cast<std::size_t>(Uniform(0, 1) * static_cast<double>(_world.Targets.size()));
        plane.CircleAround = _world.Targets[target].At(StartS + plane.CircleFromS + CircleS / 2);
        _planes.push_back(std::move(plane));
    }
}

Swarm::World TrackingFleet::RandomWorld(std::uint64_t seed)
{
    std::mt19937_64 random(seed * 7919 + 1);
    const auto uniform = [&](double from, double to)
    { return std::uniform_real_distribution<double>(from, to)(random); };
    Swarm::World world;
    world.GroundM = GroundM;
    const double crossingNorth = uniform(-80, 80);
    const Swarm::Offset crossing{crossingNorth, uniform(-120, 120), 0};
    std::vector<Swarm::Offset> starts{crossing};
    while (starts.size() < 7)
    {
        const double north = uniform(-130, 130);
        const Swarm::Offset start{north, uniform(-180, 180), 0};
        if (std::all_of(starts.begin(), starts.end(),
                        [&](const Swarm::Offset &other)
                        { return std::hypot(start.NorthM - other.NorthM, start.EastM - other.EastM) > 45; }))
            starts.push_back(start);
    }
    for (std::size_t i = 1; i < starts.size(); ++i)
    {
        const double speed = uniform(0.6, 1.6);
        const double heading = uniform(0, 2 * std::numbers::pi);
        world.Targets.push_back(Walker(starts[i], i % 2 == 0 ? 0 : speed, heading, uniform(20, 60)));
    }
    // The two targets are in the middle at the same time, again and again.
    const double heading = uniform(0, 2 * std::numbers::pi);
    for (const double turn : {0.0, uniform(0.6, 2.5)})
    {
        const double towards = heading + turn;
        world.Targets.push_back(
            Walker({crossing.NorthM - 25 * std::cos(towards), crossing.EastM - 25 * std::sin(towards), 0},
                   1.2, towards, 50));
    }
    return world;
}

double TrackingFleet::Uniform(double from, double to)
{
    return std::uniform_real_distribution<double>(from, to)(_random);
}

bool TrackingFleet::IsAway(int aircraft) const
{
    return aircraft == 1 && _timeS >= _scene.AwayFromS && _timeS < _scene.AwayToS;
}

bool TrackingFleet::Hear(int a, int b) const
{
    const bool deaf = a + b == 2 && a != b && _timeS >= _scene.DeafFromS && _timeS < _scene.DeafToS;
    return a == b || !(deaf || IsAway(a) || IsAway(b));
}

Uav::Pose TrackingFleet::PoseOf(const Plane &plane) const
{
    Swarm::GeoPoint place;
    double yaw = 0;
    if (const double circling = _timeS - plane.CircleFromS; circling >= 0 && circling < CircleS)
    {
        const double angle = circling * SpeedMps / CircleM;
        place = Swarm::Moved(plane.CircleAround, {CircleM * std::cos(angle), CircleM * std::sin(angle), 0});
        yaw = angle + std::numbers::pi / 2;
    }
    else
    {
        const auto [offset, heading] = OnLanes(plane.LanePhaseM + SpeedMps * _timeS);
        place = Swarm::Moved(Middle, offset);
        yaw = heading;
    }
    Uav::Pose pose;
    pose.latitude_deg = place.LatitudeDeg;
    pose.longitude_deg = place.LongitudeDeg;
    pose.altitude_m = GroundM + HeightM;
    pose.yaw_rad = static_cast<float>(yaw);
    pose.gps_time_s = StartS + _timeS;
    return pose;
}

void TrackingFleet::Step()
{
    for (int i = 0; i < Aircraft; ++i)
        if (!IsAway(i))
            TakeFrame(i);
    _timeS += FrameS;
    Deliver();
    for (int i = 0; i < Aircraft; ++i)
        TellOthers(i);
}

void TrackingFleet::TakeFrame(int aircraft)
{
    Plane &plane = _planes[static_cast<std::size_t>(aircraft)];
    auto frame = std::make_shared<Uav::Detections>();
    frame->seen_by = NameOf(aircraft);
    frame->frame = ++plane.Frame;
    frame->pose = PoseOf(plane);
    const Swarm::Footprint view = *Swarm::Camera::LookDown(frame->pose, GroundM);
    for (std::size_t i = 0; i < _world.Targets.size(); ++i)
        if (view.Find(_world.Targets[i].At(frame->pose.gps_time_s)).IsInside())
            _seenS[i].push_back(_timeS);
    frame->items = plane.Camera.Detect(view, _world, frame->pose.gps_time_s);
    for (int alarms = std::poisson_distribution<int>(_scene.FalseAlarmsPerFrame)(_random); alarms > 0;
         --alarms)
    {
        const double right = Uniform(-1, 1);
        const Swarm::GeoPoint place = view.At({right, Uniform(-1, 1)});
        Uav::Detection alarm;
        alarm.latitude_deg = place.LatitudeDeg;
        alarm.longitude_deg = place.LongitudeDeg;
        alarm.sigma_m = static_cast<float>(Swarm::Camera::SigmaPerHeight * HeightM);
        frame->items.push_back(alarm);
    }
    // The aircraft's own position has an error, which shifts all its detections.
    for (Uav::Detection &detection : frame->items)
    {
        const Swarm::GeoPoint wrong =
            Swarm::Moved({detection.latitude_deg, detection.longitude_deg, GroundM}, plane.Bias);
        detection.latitude_deg = wrong.LatitudeDeg;
        detection.longitude_deg = wrong.LongitudeDeg;
    }
    if (!frame->items.empty())
        for (int to = 0; to < Aircraft; ++to)
            if (Hear(aircraft, to))
                Send(aircraft, to, frame);
}

// An aircraft gets its own messages at once, and always.
void TrackingFleet::Send(int from, int to, const std::shared_ptr<const Rabit::RabitMessage> &message)
{
    const double delay = std::exponential_distribution<double>(1 / _scene.MeanDelayS)(_random);
    const bool late = Uniform(0, 1) < _scene.LateShare;
    const bool lost = Uniform(0, 1) < _scene.LostShare;
    if (from == to)
        _underWay[{_timeS, ++_sent}] = {to, message};
    else if (!lost)
        _underWay[{_timeS + delay + (late ? LateS : 0), ++_sent}] = {to, message};
}

void TrackingFleet::TellOthers(int aircraft)
{
    const auto told = std::make_shared<const Uav::Targets>(
        _planes[static_cast<std::size_t>(aircraft)].Table->Tell(StartS + _timeS));
    if (!told->items.empty())
        for (int to = 0; to < Aircraft; ++to)
            if (to != aircraft && Hear(aircraft, to))
                Send(aircraft, to, told);
}

void TrackingFleet::Deliver()
{
    while (!_underWay.empty() && _underWay.begin()->first.first < _timeS)
    {
        const auto [to, message] = _underWay.begin()->second;
        _underWay.erase(_underWay.begin());
        Swarm::TargetTable &table = *_planes[static_cast<std::size_t>(to)].Table;
        if (const auto *const frame = dynamic_cast<const Uav::Detections *>(message.get()))
            table.Add(*frame);
        else if (const auto *const told = dynamic_cast<const Uav::Targets *>(message.get()))
            table.Hear(*told);
    }
}

Uav::Targets TrackingFleet::ReportOf(int aircraft) const
{
    Uav::Targets targets;
    _planes[static_cast<std::size_t>(aircraft)].Table->Report(StartS + _timeS, targets);
    return targets;
}

int TrackingFleet::TimesSeen(std::size_t target, double seconds) const
{
    const std::vector<double> &seen = _seenS[target];
    return static_cast<int>(seen.end() - std::lower_bound(seen.begin(), seen.end(), _timeS - seconds));
}

}  // namespace SwarmTest
