#pragma once

#include "StandStill.h"

#include <Eigen/Core>

namespace Swarm
{

// Where one target is and how it moves, from detections: a Kalman filter in metres north and east of a fixed
// point. The target is taken to move at a constant velocity that white noise changes (Bar-Shalom, Li,
// Kirubarajan: "Estimation with Applications to Tracking and Navigation", 2001, section 6.2.2), or to stand:
// which of the two, StandStill weighs. One that has not been seen for a while is taken to be where it was
// last expected, with an uncertainty that goes on growing, slowly if it stands and quickly if it walks.
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
    static constexpr double CoastS = 5;          // unseen for longer it wanders about
    static constexpr double WanderM2ps = 30;     // growth of the variance then
    static constexpr double WanderMaxM2 = 1600;  // people turn round

    // Begins with one detection, `sigmaM` being its standard deviation in north and in east.
    TargetFilter(const Place &measured, double sigmaM, double timeS);

    // At a later time. A time before the last detection counts as that.
    Estimate At(double timeS) const;
    // How unlikely a detection is to be this target: its squared Mahalanobis distance, which is chi-square
    // distributed with two degrees of freedom if it is.
    double Distance2(const Place &measured, double sigmaM, double timeS) const;
    // Natural logarithm of the probability density, per square metre, of seeing it there.
    double LogDensity(const Place &measured, double sigmaM, double timeS) const;
    void Update(const Place &measured, double sigmaM, double timeS);
    // The other one has followed the same target before this one did.
    void Inherit(const TargetFilter &before);
    double UpdatedS() const { return _timeS; }
    double StandsProbability() const { return _stand.Probability(); }

private:
    // What a detection at that time is expected to be if the target walks, and how it goes with the state at
    // the time of the last detection, or later.
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

    Estimate _estimate;  // of one that walks
    double _timeS;
    StandStill _stand;
};

}  // namespace Swarm
