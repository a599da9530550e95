#pragma once

#include <Eigen/Core>

namespace Swarm
{

// Where one target is and how it moves, from detections: a Kalman filter in metres north and east of a fixed
// point. The target is taken to move at a constant velocity that white noise changes (Bar-Shalom, Li,
// Kirubarajan: "Estimation with Applications to Tracking and Navigation", 2001, section 6.2.2); one that has
// not been seen for a while, to linger where it was last expected, with an uncertainty that goes on growing.
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
    static constexpr double NoiseM2ps3 = 0.05;  // spectral density of the acceleration
    static constexpr double CoastS = 5;         // unseen for longer it lingers
    static constexpr double LingerM2ps = 2;     // growth of the variance then

    // Begins with one detection, `sigmaM` being its standard deviation in north and in east.
    TargetFilter(const Place &measured, double sigmaM, double timeS);

    // At a later time. A time before the last detection counts as that.
    Estimate At(double timeS) const;
    // How unlikely a detection is to be this target: its squared Mahalanobis distance, which is chi-square
    // distributed with two degrees of freedom if it is.
    double Distance2(const Place &measured, double sigmaM, double timeS) const;
    void Update(const Place &measured, double sigmaM, double timeS);
    double UpdatedS() const { return _timeS; }

private:
    Estimate _estimate;
    double _timeS;
};

}  // namespace Swarm
