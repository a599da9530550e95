#include "TargetFilter.h"

#include <Eigen/LU>

#include <algorithm>

namespace Swarm
{

TargetFilter::TargetFilter(const Place &measured, double sigmaM, double timeS) : _timeS(timeS)
{
    _estimate.State << measured, 0, 0;
    const double place = sigmaM * sigmaM;
    const double speed = StartSpeedSigmaMps * StartSpeedSigmaMps;
    _estimate.Covariance = Eigen::Vector4d(place, place, speed, speed).asDiagonal();
}

TargetFilter::Estimate TargetFilter::At(double timeS) const
{
    const double unseen = std::max(0.0, timeS - _timeS);
    const double t = std::min(unseen, CoastS);
    Eigen::Matrix4d move = Eigen::Matrix4d::Identity();
    move.topRightCorner<2, 2>() = Eigen::Matrix2d::Identity() * t;
    // Of a white-noise acceleration over that time.
    Eigen::Matrix4d noise = Eigen::Matrix4d::Zero();
    noise.topLeftCorner<2, 2>().diagonal().setConstant(NoiseM2ps3 * t * t * t / 3 +
                                                       LingerM2ps * (unseen - t));
    noise.topRightCorner<2, 2>().diagonal().setConstant(NoiseM2ps3 * t * t / 2);
    noise.bottomLeftCorner<2, 2>() = noise.topRightCorner<2, 2>();
    noise.bottomRightCorner<2, 2>().diagonal().setConstant(NoiseM2ps3 * t);
    Estimate later;
    later.State = move * _estimate.State;
    later.Covariance = move * _estimate.Covariance * move.transpose() + noise;
    if (unseen > CoastS)
        later.State.tail<2>().setZero();
    return later;
}

double TargetFilter::Distance2(const Place &measured, double sigmaM, double timeS) const
{
    const Estimate expected = At(timeS);
    const Eigen::Matrix2d covariance =
        expected.PositionCovariance() + Eigen::Matrix2d::Identity() * sigmaM * sigmaM;
    const Place difference = measured - expected.Position();
    return difference.dot(covariance.inverse() * difference);
}

void TargetFilter::Update(const Place &measured, double sigmaM, double timeS)
{
    const Estimate expected = At(timeS);
    const Eigen::Matrix2d noise = Eigen::Matrix2d::Identity() * sigmaM * sigmaM;
    const Eigen::Matrix2d innovation = expected.PositionCovariance() + noise;
    const Eigen::Matrix<double, 4, 2> gain = expected.Covariance.leftCols<2>() * innovation.inverse();
    _estimate.State = expected.State + gain * (measured - expected.Position());
    // Joseph's form stays symmetric and positive.
    Eigen::Matrix4d rest = Eigen::Matrix4d::Identity();
    rest.leftCols<2>() -= gain;
    _estimate.Covariance = rest * expected.Covariance * rest.transpose() + gain * noise * gain.transpose();
    _timeS = std::max(_timeS, timeS);
}

}  // namespace Swarm
