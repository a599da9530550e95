#pragma once

#include "StandStill.h"

#include <Eigen/Core>

namespace Swarm
{

// Estimates position and velocity of one target from detections: a Kalman filter in metres north and east
// of a fixed point. The target either moves at a constant velocity with white-noise acceleration
// (Bar-Shalom, Li, Kirubarajan: "Estimation with Applications to Tracking and Navigation", 2001, section
// 6.2.2), or stands; StandStill weighs the two. If it has not been seen for a while, the estimate stays at
// its last expected place, and its uncertainty keeps growing: slowly if it stands, quickly if it walks.
//
// A detection may be older than the last one: it is compared with where the target was then.
//
// Times are in seconds of any one clock. Not thread-safe.
class TargetFilter
{
public:
    using Place = Eigen::Vector2d;  // north, east
    struct Estimate
    {
        Eigen::Vector4d State;  // north, east, and their velocities
        Eigen::Matrix4d Covariance;

        Place Position() const { return State.head<2>(); }
        Eigen::Matrix2d PositionCovariance() const { return Covariance.topLeftCorner<2, 2>(); }
    };

    static constexpr double StartSpeedSigmaMps = 1.5;
    static constexpr double NoiseM2ps3 = 0.05;   // spectral density of the acceleration
    static constexpr double CoastS = 5;          // a target unseen for longer wanders about
    static constexpr double WanderM2ps = 30;     // growth of the variance then
    static constexpr double WanderMaxM2 = 1600;  // people turn round

    // Begins with one detection, `sigmaM` being its standard deviation in north and in east.
    TargetFilter(const Place &measured, double sigmaM, double timeS);

    // The estimate at a later time. An earlier time counts as that of the last detection.
    Estimate At(double timeS) const;
    // The squared Mahalanobis distance of a detection. If the detection is of this target, it is chi-square
    // distributed with two degrees of freedom.
    double Distance2(const Place &measured, double sigmaM, double timeS) const;
    // Natural logarithm of the probability density, per square metre, of seeing it there.
    double LogDensity(const Place &measured, double sigmaM, double timeS) const;
    void Update(const Place &measured, double sigmaM, double timeS);
    // Takes over the evidence of an earlier filter of the same target.
    void Inherit(const TargetFilter &before);

private:
    // The expected detection of a walking target at that time, and its relation to the state at the time of
    // the last detection, or later.
    struct Expectation
    {
        Estimate Walking;                         // what the detection will change
        Place Measured;                           // of the place
        Eigen::Matrix2d Covariance;               // without the detection's own
        Eigen::Matrix<double, 2, 4> Observation;  // of the state
        double ExtraM2 = 0;                       // of the detection, for what happened between then and now
    };

    Estimate Walking(double timeS) const;
    Expectation Expect(double timeS) const;

    Estimate _estimate;  // if it walks
    double _timeS;
    StandStill _stand;
};

}  // namespace Swarm
